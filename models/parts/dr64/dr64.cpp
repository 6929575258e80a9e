#include "models/parts/dr64/dr64.h"

#include "models/parts/bps32/bps32_isa.h"

namespace dendro::dr64 {
namespace {

constexpr std::size_t kBankPixels = std::size_t{kWidth} * kHeight;

struct WordPlace {
  unsigned card, plane;
  std::size_t first;  ///< index of the first of eight pixels, within a bank
};

WordPlace word_place(std::uint32_t address) {
  const unsigned y = (address >> 6) & 0x1FF;
  const unsigned x = (address & 0x3F) * 8;
  return {(address >> 16) & 0xF, (address >> 15) & 1, std::size_t{y} * kWidth + x};
}

bool is_mask_load(unsigned function) {
  return function == bps32::kFnMaskWord || function == bps32::kFnMaskLores || function == bps32::kFnMaskHires;
}

bool known(unsigned function) {
  return function == bps32::kFnWord || function == bps32::kFnLores || function == bps32::kFnHires ||
         is_mask_load(function);
}

// Spreads the two planes' bits of a hires pixel to bits 6 and 7 of each card's byte.
std::uint32_t hires_of(std::uint32_t pixel, unsigned bit) {
  return (((pixel >> bit) & 0x01010101u) << 6) | (((pixel >> (bit + 4)) & 0x01010101u) << 7);
}

}  // namespace

Core::Core(const Spec& spec) : spec_(spec) { state_.pixels.assign(kBankPixels * spec.banks, 0); }

bool Core::pixel_index(std::uint32_t address, bool hires, std::size_t& index, unsigned& nibble_bit) const {
  const unsigned bank = (address >> 20) & 7;
  if (bank >= spec_.banks) return false;
  unsigned x, y;
  nibble_bit = 0;
  if (hires) {
    const unsigned hx = address & 0x3FF, hy = (address >> 10) & 0x3FF;
    x = hx / 4 + 256 * (hy & 1);
    y = hy / 2;
    nibble_bit = hx & 3;
  } else {
    x = (address & 0x3FF) >> 1;
    y = (address >> 11) & 0x1FF;
  }
  index = bank * kBankPixels + std::size_t{y} * kWidth + x;
  return true;
}

Work Core::probe(std::uint32_t address, unsigned function, bool write) const {
  Work work;
  if (!known(function)) return work;
  if (write && is_mask_load(function)) {
    work.answered = true;
    return work;
  }
  const unsigned kind = function & 3;
  if (kind == bps32::kFnWord) {
    const unsigned card = word_place(address).card;
    if (card >= spec_.cards()) return work;
    work.cards = 1u << card;
    work.masked = write && state_.mask_word != 0xFFFFFFFF;
  } else {
    const unsigned bank = (address >> 20) & 7;
    if (bank >= spec_.banks) return work;
    work.cards = ((1u << spec_.cards_per_bank) - 1) << (bank * spec_.cards_per_bank);
    const std::uint32_t mask = kind == bps32::kFnLores ? state_.mask_lores : state_.mask_hires;
    work.masked = write && (mask & spec_.pixel_mask()) != spec_.pixel_mask();
  }
  work.answered = true;
  return work;
}

std::optional<std::size_t> Core::touched(std::uint32_t address, unsigned function, bool write) const {
  if (probe(address, function, write).cards == 0) return std::nullopt;
  const unsigned kind = function & 3;
  if (kind == bps32::kFnWord) return word_place(address).first;
  std::size_t index = 0;
  unsigned bit = 0;
  pixel_index(address, kind == bps32::kFnHires, index, bit);
  return index % kBankPixels;
}

std::uint32_t Core::hires(unsigned x, unsigned y) const {
  return hires_of(state_.pixels[std::size_t{y / 2} * kWidth + x / 4 + 256 * (y & 1)], x & 3);
}

std::uint32_t Core::read(std::uint32_t address, unsigned function) const {
  if (!known(function)) return 0;
  const unsigned kind = function & 3;
  if (kind == bps32::kFnWord) {
    const WordPlace at = word_place(address);
    if (at.card >= spec_.cards()) return 0;
    const std::size_t bank = at.card / spec_.cards_per_bank;
    const unsigned shift = 8 * (at.card % spec_.cards_per_bank) + 4 * at.plane;
    std::uint32_t data = 0;
    for (unsigned k = 0; k < 8; ++k)
      data |= ((state_.pixels[bank * kBankPixels + at.first + k] >> shift) & 0xF) << (4 * k);
    return data;
  }
  std::size_t index;
  unsigned bit;
  if (!pixel_index(address, kind == bps32::kFnHires, index, bit)) return 0;
  return kind == bps32::kFnHires ? hires_of(state_.pixels[index], bit) : state_.pixels[index];
}

void Core::write(std::uint32_t address, std::uint32_t data, unsigned function) {
  if (!known(function)) return;
  if (function == bps32::kFnMaskWord) state_.mask_word = data;
  if (function == bps32::kFnMaskLores) state_.mask_lores = data;
  if (function == bps32::kFnMaskHires) state_.mask_hires = data;
  if (is_mask_load(function)) return;
  if (function == bps32::kFnWord) {
    const WordPlace at = word_place(address);
    if (at.card >= spec_.cards()) return;
    const std::size_t bank = at.card / spec_.cards_per_bank;
    const unsigned shift = 8 * (at.card % spec_.cards_per_bank) + 4 * at.plane;
    for (unsigned k = 0; k < 8; ++k) {
      std::uint32_t& pixel = state_.pixels[bank * kBankPixels + at.first + k];
      const std::uint32_t enable = ((state_.mask_word >> (4 * k)) & 0xF) << shift;
      pixel = (pixel & ~enable) | ((((data >> (4 * k)) & 0xF) << shift) & enable);
    }
    return;
  }
  std::size_t index;
  unsigned bit;
  const bool hires = function == bps32::kFnHires;
  if (!pixel_index(address, hires, index, bit)) return;
  std::uint32_t enable, value;
  if (hires) {
    const std::uint32_t mask = state_.mask_hires;
    enable = (((mask >> 6) & 0x01010101u) << bit) | (((mask >> 7) & 0x01010101u) << (bit + 4));
    value = (((data >> 6) & 0x01010101u) << bit) | (((data >> 7) & 0x01010101u) << (bit + 4));
  } else {
    enable = state_.mask_lores;
    value = data;
  }
  enable &= spec_.pixel_mask();
  state_.pixels[index] = (state_.pixels[index] & ~enable) | (value & enable);
}

}  // namespace dendro::dr64
