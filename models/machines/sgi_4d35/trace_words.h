#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <memory>
#include <unordered_map>

namespace dendro::sgi_4d35 {

/// The words of main memory that a trace knows, by physical address; 0 where it knows none.
class TraceWords {
 public:
  bool known(std::uint32_t address) const {
    const Page* page = find(address);
    return page != nullptr && page->known[index(address)];
  }
  std::uint32_t at(std::uint32_t address) const {
    const Page* page = find(address);
    return page == nullptr ? 0 : page->words[index(address)];
  }
  void put(std::uint32_t address, std::uint32_t word) {
    auto& page = pages_[address / kPageBytes];
    if (!page) page = std::make_unique<Page>();
    page->words[index(address)] = word;
    page->known[index(address)] = true;
  }
  /// Changes the bits of `mask` only.
  void put(std::uint32_t address, std::uint32_t word, std::uint32_t mask) {
    put(address, (at(address) & ~mask) | (word & mask));
  }

 private:
  static constexpr std::uint32_t kPageBytes = 4096;
  struct Page {
    std::array<std::uint32_t, kPageBytes / 4> words{};
    std::bitset<kPageBytes / 4> known;
  };
  static std::uint32_t index(std::uint32_t address) { return address % kPageBytes / 4; }
  const Page* find(std::uint32_t address) const {
    const auto page = pages_.find(address / kPageBytes);
    return page == pages_.end() ? nullptr : page->second.get();
  }

  std::unordered_map<std::uint32_t, std::unique_ptr<Page>> pages_;
};

/// The bits of a word that `size` bytes from an address on occupy, big-endian; they do not reach beyond it.
inline std::uint32_t bytes_mask(std::uint32_t address, unsigned size) {
  const std::uint32_t all = size == 4 ? ~0u : (1u << 8 * size) - 1;
  return all << 8 * (4 - (address & 3) - size);
}

}  // namespace dendro::sgi_4d35
