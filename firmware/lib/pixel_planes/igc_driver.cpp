#include "firmware/lib/pixel_planes/igc_driver.h"

#include <cstring>

#include "sim/base/check.h"

namespace dendro::lib {
namespace {

constexpr std::uint32_t kControlStore = 0x0000, kFifo = 0x1000, kVideoBase = 0x1002, kVideoSize = 0x1003, kSelect = 0x1004;
constexpr std::uint32_t kExpression = 1u << 22, kConstant = 1u << 23, kLongConstant = 1u << 24, kCopy = 1u << 30, kRegister = 1u << 31;

std::uint32_t bits_of(float value) {
  std::uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

}  // namespace

void IgcPrograms::append(const IgcPrograms& more) {
  const auto offset = static_cast<unsigned>(words.size());
  words.insert(words.end(), more.words.begin(), more.words.end());
  for (const auto& [program, entry] : more.entries) {
    entries[program] = entry;
    entries[program].at += offset;
  }
  for (const auto& [register_name, number] : more.registers) registers[register_name] = number;
}

void IgcDriver::load() {
  Work work;
  work.program_loads = 1;
  host_.compute(work);
  std::vector<std::uint32_t> words;
  for (const std::uint64_t word : programs_.words) {
    words.push_back(static_cast<std::uint32_t>(word));
    words.push_back(static_cast<std::uint32_t>(word >> 32));
  }
  host_.dma_to(kControlStore, words.data(), words.size(), 0);
  host_.program(programs_.name, 0);
}

void IgcDriver::show(unsigned colour_low, int width, int height) {
  host_.write(kVideoBase, colour_low, 0);
  host_.write(kVideoSize, static_cast<std::uint32_t>(width) | static_cast<std::uint32_t>(height) << 16, 0);
}

void IgcDriver::select(std::size_t number) { host_.write(kSelect, static_cast<std::uint32_t>(number), 0); }

void IgcDriver::copy_tile(int column, int row) {
  const std::uint32_t words[] = {kCopy, static_cast<std::uint32_t>(column) | static_cast<std::uint32_t>(row) << 16};
  host_.dma_to(kFifo, words, 2, 0, 0);
}

void IgcDriver::set_register(const std::string& name, unsigned value) {
  DENDRO_CHECK(programs_.registers.count(name) != 0 && value < 256, "{} = {}", name, value);
  host_.write(kFifo, kRegister | programs_.registers.at(name) << 8 | value, 0);
}

void IgcDriver::run(const std::string& program, std::optional<std::uint64_t> constant) {
  send(program, nullptr, 0, 0, constant);
}

void IgcDriver::run(const std::string& program, const Expression& expression, unsigned fraction, unsigned guard,
                    std::optional<std::uint64_t> constant) {
  send(program, &expression, fraction, guard, constant);
}

void IgcDriver::send(const std::string& program, const Expression* expression, unsigned fraction, unsigned guard,
                     const std::optional<std::uint64_t>& constant) {
  DENDRO_CHECK(programs_.entries.count(program) != 0 && fraction < 64 && guard < 64, "{} {} {}", program, fraction, guard);
  std::vector<std::uint32_t> words{programs_.entries.at(program).at | fraction << 10 | guard << 16};
  if (expression) {
    words[0] |= kExpression;
    for (const float value : {expression->a, expression->b, expression->c}) words.push_back(bits_of(value));
  }
  if (constant) {
    words[0] |= kConstant;
    words.push_back(static_cast<std::uint32_t>(*constant));
    if (*constant >> 32 != 0) {
      words[0] |= kLongConstant;
      words.push_back(static_cast<std::uint32_t>(*constant >> 32));
    }
  }
  host_.dma_to(kFifo, words.data(), words.size(), 0, 0);
}

}  // namespace dendro::lib
