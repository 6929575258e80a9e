#pragma once

#include "models/parts/r3000/r3000.h"

namespace dendro::r3000 {

template <class Port, class Timing>
void Core<Port, Timing>::forget_maps() {
  for (Maps& maps : maps_) maps = Maps();
  for (auto& fetches : fetches_) fetches.fill(FetchMapping());
  refetch_ = true;
}

template <class Port, class Timing>
void Core<Port, Timing>::forget() {
  code_.clear();
  forget_maps();
  if constexpr (kTimed) {  // the pipeline begins at pc
    careful_ = true;
    deferred_ = false;
    lost_ = 2;
  }
}

template <class Port, class Timing>
void Core<Port, Timing>::forget_code(std::uint32_t physical) {
  if (code_.erase(physical & kPageMask) == 0) return;
  for (auto& fetches : fetches_) fetches.fill(FetchMapping());
  careful_ = true;
  refetch_ = true;
}

template <class Port, class Timing>
void Core<Port, Timing>::jump(std::uint32_t address) {
  if constexpr (kTimed) {
    catch_up(0);
    careful_ = true;
    lost_ = 2;
  }
  finish_load(s_);
  s_.pc = address;
  s_.next_pc = address + 4;
  s_.in_slot = false;
  refetch_ = true;
}

template <class Port, class Timing>
bool Core<Port, Timing>::misaligned(std::uint32_t address, unsigned size, Access access) {
  if ((address & (size - 1)) == 0) return false;
  fault_ = {};
  fault_.code = access == Access::kStore ? kAdes : kAdel;
  fault_.address = address;
  fault_.has_address = true;
  return true;
}

template <class Port, class Timing>
bool Core<Port, Timing>::load(std::uint32_t address, unsigned size, std::uint32_t& value) {
  const Mapping& m = maps().read[address >> 12 & (kMappings - 1)];
  if ((address & (kPageMask | (size - 1))) != m.tag) return slow_load(address, size, value);
  const std::uint8_t* p = m.bytes + (address & ~kPageMask);
  if constexpr (kTimed) time_.read(m.physical | (address & ~kPageMask));
  value = size == 4 ? load32(p) : size == 2 ? load16(p) : *p;
  return true;
}

template <class Port, class Timing>
bool Core<Port, Timing>::store(std::uint32_t address, unsigned size, std::uint32_t value) {
  const Mapping& m = maps().write[address >> 12 & (kMappings - 1)];
  if ((address & (kPageMask | (size - 1))) != m.tag) return slow_store(address, size, value);
  std::uint8_t* p = m.bytes + (address & ~kPageMask);
  if constexpr (kTimed) time_.write(m.physical | (address & ~kPageMask), size);
  if (size == 4) {
    store32(p, value);
  } else {
    if (size == 2) *p++ = static_cast<std::uint8_t>(value >> 8);
    *p = static_cast<std::uint8_t>(value);
  }
  return true;
}

template <class Port, class Timing>
bool Core<Port, Timing>::slow_load(std::uint32_t address, unsigned size, std::uint32_t& value) {
  std::uint32_t physical = 0;
  if (misaligned(address, size, Access::kLoad) || !translate(s_, address, Access::kLoad, physical, fault_))
    return false;
  std::uint8_t* const bytes = port_.page(physical);
  const bool cached = kTimed && bytes != nullptr && !uncached(s_, address);
  if (s_.status & kStatusIsc) {  // the caches alone; data is not in them
    if constexpr (kTimed) time_.isolated_read(cached);
    value = 0;
    return true;
  }
  if constexpr (kTimed) {
    if (!cached) time_.read_uncached(physical);
    if (bytes != nullptr && !cached) {
      const std::uint8_t* p = bytes + (physical & ~kPageMask);
      value = size == 4 ? load32(p) : size == 2 ? load16(p) : *p;
      return true;
    }
  }
  if (bytes != nullptr) {
    maps().read[address >> 12 & (kMappings - 1)] = {address & kPageMask, physical & kPageMask, bytes};
    return load(address, size, value);
  }
  leave_ = touched_ = true;
  if (port_.read(physical, size, value)) return true;
  fault_ = {};
  fault_.code = kDbe;
  return false;
}

template <class Port, class Timing>
bool Core<Port, Timing>::slow_store(std::uint32_t address, unsigned size, std::uint32_t value) {
  std::uint32_t physical = 0;
  if (misaligned(address, size, Access::kStore) || !translate(s_, address, Access::kStore, physical, fault_))
    return false;
  std::uint8_t* const bytes = port_.page(physical);
  const bool cached = !kTimed || (bytes != nullptr && !uncached(s_, address));
  if (s_.status & kStatusIsc) {
    if constexpr (kTimed)
      if (cached) time_.isolated_write(physical, size, s_.status & kStatusSwc);
    return true;
  }
  if (bytes != nullptr) {
    const auto code = code_.find(physical & kPageMask);
    if (code == code_.end() && cached) {
      maps().write[address >> 12 & (kMappings - 1)] = {address & kPageMask, physical & kPageMask, bytes};
      return store(address, size, value);
    }
    std::uint8_t* p = bytes + (physical & ~kPageMask);
    for (unsigned i = 0; i < size; ++i) p[i] = static_cast<std::uint8_t>(value >> 8 * (size - 1 - i));
    if constexpr (kTimed) {
      if (cached)
        time_.write(physical, size);
      else
        time_.write_uncached(physical);
    }
    if (code == code_.end()) return true;
    forget_code(physical);
    leave_ |= kTimed;
    return true;
  }
  leave_ = touched_ = true;
  if (port_.write(physical, size, value)) {
    port_.changed_pages([this](std::uint32_t page) { forget_code(page); });
    if constexpr (kTimed) time_.write_uncached(physical);
    return true;
  }
  fault_ = {};
  fault_.code = kDbe;
  return false;
}

template <class Port, class Timing>
auto Core<Port, Timing>::fetch_page(std::uint32_t address) -> CodePage* {
  if (CodePage* const page = known_page(address)) return page;
  std::uint32_t physical = 0;
  if (misaligned(address, 4, Access::kFetch) || !translate(s_, address, Access::kFetch, physical, fault_))
    return nullptr;
  const auto found = code_.find(physical & kPageMask);
  CodePage* const page = found != code_.end() ? found->second.get() : decode_code(physical & kPageMask);
  if constexpr (!kTimed)
    if (page != nullptr) fetches_[s_.user()][address >> 12 & (kMappings - 1)] = {address & kPageMask, page->physical, page};
  return page;
}

/// Of a physical page; a bus error if it is not memory.
template <class Port, class Timing>
auto Core<Port, Timing>::decode_code(std::uint32_t physical) -> CodePage* {
  const std::uint8_t* const bytes = port_.page(physical);
  if (bytes == nullptr) {
    fault_ = {};
    fault_.code = kIbe;
    return nullptr;
  }
  std::array<std::uint32_t, kPageWords> words;
  for (unsigned i = 0; i < kPageWords; ++i) words[i] = load32(bytes + 4 * i);
  auto code = std::make_unique<CodePage>();
  code->physical = physical;
  decode_page(words.data(), kPageWords, code->words.data());
  if constexpr (kTimed) {
    code->issues.resize(kPageWords);
    for (unsigned i = 0; i < kPageWords; ++i) {
      const Op op = code->words[i].op;
      if (op == Op::kFp) code->issues[i] = time_.issue_of(words[i]);
      if (op == Op::kMtc0 || (op >= Op::kTlbr && op <= Op::kRfe)) code->plain = false;
    }
  }
  forget_maps();  // from here on a store to this page must be noticed
  return (code_[physical] = std::move(code)).get();
}

/// lwl takes the bytes from the address to the end of its word into the top of the register, lwr those from
/// the word's beginning to the address into its bottom [GEN; MIPS I].
template <class Port, class Timing>
bool Core<Port, Timing>::load_part(const Decoded& d, bool left, std::uint32_t& value) {
  const std::uint32_t address = s_.r[d.rs] + d.imm;
  const unsigned byte = address & 3;
  std::uint32_t word = 0;
  if (!load(address & ~3u, 4, word)) {
    if (fault_.has_address) fault_.address = address;
    return false;
  }
  const std::uint32_t old = merge_ ? merge_value_ : s_.r[d.rt];
  if (left)
    value = word << 8 * byte | (byte == 0 ? 0 : old & (0xFFFFFFFFu >> (32 - 8 * byte)));
  else
    value = word >> 8 * (3 - byte) | (byte == 3 ? 0 : old & (0xFFFFFFFFu << 8 * (byte + 1)));
  return true;
}

template <class Port, class Timing>
bool Core<Port, Timing>::store_part(const Decoded& d, bool left) {
  const std::uint32_t address = s_.r[d.rs] + d.imm;
  const std::uint32_t value = s_.r[d.rt];
  const unsigned first = left ? address & 3 : 0, last = left ? 3 : address & 3;
  for (unsigned i = first; i <= last; ++i) {
    const unsigned down = left ? 8 * (3 - (i - first)) : 8 * (last - i);
    if constexpr (kTimed) time_.part(i != first);  // one access, whatever number of bytes
    const bool good = store((address & ~3u) + i, 1, value >> down & 0xFF);
    if constexpr (kTimed) time_.part(false);
    if (!good) {
      if (fault_.has_address) fault_.address = address;
      return false;
    }
  }
  return true;
}

}  // namespace dendro::r3000
