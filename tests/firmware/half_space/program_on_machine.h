#pragma once

#include <fstream>
#include <functional>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

#include "firmware/lib/rds3000/rds_driver.h"
#include "firmware/tools/assembler.h"
#include "models/machines/rds3000/function.h"
#include "models/parts/bps32/bps32_isa.h"

namespace dendro::half_space::testing_programs {

constexpr int kFrame = 512;

inline std::string text_of(const std::string& path) {
  std::ifstream in(path);
  if (!in) throw std::runtime_error("cannot read " + path);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A shipped microprogram, by its path below the repository's root, for a multiplier of so many words.
inline lib::ProgramImage assembled(const std::string& path, const std::string& pack,
                                   unsigned multiply_ticks = 2) {
  tools::AssembleOptions options;
  options.pack = pack;
  options.multiply_ticks = multiply_ticks;
  options.fill_products = true;
  options.include = [](const std::string& included) {
    return std::optional(text_of(SOURCE_ROOT "/" + included));
  };
  const tools::Ucode ucode = tools::assemble(text_of(SOURCE_ROOT "/" + path), path, options).ucode;
  lib::ProgramImage image;
  image.words = ucode.words;
  image.entry = ucode.entry;
  for (const auto& [name, area] : ucode.scratch) image.scratch[name] = {area.address, area.size};
  image.initial_scratch = ucode.scratch_data;
  return image;
}

/// 512 x 512 pixel words, rows top down.
using Frame = std::vector<std::uint32_t>;

inline void put_frame(HostPort& host, const Frame& frame) {
  for (std::uint32_t y = 0; y < kFrame; ++y)
    host.dma_to(y << 11, &frame[y * kFrame], kFrame, bps32::kFnLores, 2);
}

/// The frame after `program` has run on a machine with `before` in its image memory.
inline Frame frame_after(const Frame& before, const lib::ProgramImage& image, const rds3000::Spec& spec,
                         const std::function<void(lib::RdsDriver&)>& program) {
  MachineOptions options;
  options.tick_limit = 2'000'000'000;
  rds3000::FunctionEngine machine(spec, options);
  put_frame(machine, before);
  lib::RdsDriver driver(machine);
  driver.load_program(image);
  program(driver);
  Frame after(before.size());
  for (std::uint32_t y = 0; y < kFrame; ++y)
    machine.dma_from(y << 11, &after[y * kFrame], kFrame, bps32::kFnLores, 2);
  return after;
}

/// A machine with 3 or 4 cards of image memory.
inline rds3000::Spec with_cards(unsigned cards) {
  rds3000::Spec spec;
  spec.memory.cards_per_bank = cards;
  return spec;
}

/// The paper's machine but for a slower multiplier.
inline rds3000::Spec with_multiplier(int ticks) {
  rds3000::Spec spec;
  spec.processor.multiply_ticks = ticks;
  return spec;
}

}  // namespace dendro::half_space::testing_programs
