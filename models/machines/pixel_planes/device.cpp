#include "models/machines/pixel_planes/device.h"

#include <cstring>

#include "models/machines/pixel_planes/frame_store.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"

namespace dendro::pixel_planes {
namespace {

std::int64_t coefficient(std::uint32_t word, unsigned fraction) {
  float value = 0;
  std::memcpy(&value, &word, sizeof value);
  return igc::translate(value, fraction);
}

}  // namespace

std::optional<igc::Command> CommandDecoder::add(std::uint32_t word) {
  words_.push_back(word);
  const igc::Header header = igc::unpack_header(words_[0]);
  if (words_.size() < header.words()) return std::nullopt;
  igc::Command command;
  command.header = header;
  std::size_t at = 1;
  if (header.copy) {
    command.tile_x = words_[1] & 0xFFFF, command.tile_y = words_[1] >> 16;
    words_.clear();
    return command;
  }
  if (header.expression && !header.register_write) {
    for (std::int64_t* to : {&command.a, &command.b, &command.c}) *to = coefficient(words_[at++], header.fraction);
  }
  if (header.constant && !header.register_write) command.constant = words_[at++];
  if (header.long_constant && !header.register_write) command.constant |= static_cast<std::uint64_t>(words_[at++]) << 32;
  words_.clear();
  return command;
}

std::optional<Device::Done> Device::write(std::uint32_t address, std::uint32_t value) {
  if (address < kControlStoreEnd) {
    std::uint64_t& word = controller_.store[address / 2];
    word = address % 2 == 0 ? (word & ~std::uint64_t{0xFFFFFFFF}) | value
                            : (word & 0xFFFFFFFF) | static_cast<std::uint64_t>(value) << 32;
    programs_.clear();
  } else if (address == kVideoBase) {
    video_.base = value & 255;
  } else if (address == kVideoSize) {
    video_.width = static_cast<int>(value & 0xFFFF), video_.height = static_cast<int>(value >> 16);
  } else if (address == kFifo) {
    if (const auto command = decoder_.add(value)) return carry_out(*command);
  }
  return std::nullopt;
}

UserError Device::never_idle() {
  return UserError("pixel_planes: the last command lacks words, so the machine never becomes idle");
}

std::uint32_t Device::read(std::uint32_t address) const {
  if (address < kControlStoreEnd) return static_cast<std::uint32_t>(controller_.store[address / 2] >> (address % 2 * 32));
  if (address == kVideoBase) return video_.base;
  if (address == kVideoSize)
    return static_cast<std::uint32_t>(video_.width) | static_cast<std::uint32_t>(video_.height) << 16;
  return 0;
}

Device::Done Device::carry_out(const igc::Command& command) {
  if (command.header.register_write) {
    controller_.registers[command.header.register_number] = static_cast<std::uint8_t>(command.header.value);
    return {command, 1, 0};
  }
  if (command.header.copy) return {command, static_cast<std::uint64_t>(spec_.copy_words()), 0};
  auto found = programs_.find(command.header.entry);
  if (found == programs_.end())
    found = programs_.emplace(command.header.entry, MacroProgram(igc::program_at(controller_, command.header.entry))).first;
  const auto gap = static_cast<unsigned>(spec_.tree.gap_clocks);
  const std::uint64_t words = igc::count_words(found->second.words(), command.header, controller_, gap);
  if (words == 0)
    throw UserError("the micro-program at word " + std::to_string(command.header.entry) + " sends nothing");
  engine_.execute(found->second, command, controller_);
  return {command, words, static_cast<unsigned>(found->second.words().size())};
}

std::vector<igc::ArrayWord> Device::words_of(const igc::Command& command) const {
  if (command.header.register_write) return {igc::ArrayWord{}};
  if (command.header.copy) return std::vector<igc::ArrayWord>(static_cast<std::size_t>(spec_.copy_words()));
  return igc::expand(programs_.at(command.header.entry).words(), command, controller_,
                     static_cast<unsigned>(spec_.tree.gap_clocks));
}

Picture Device::picture() {
  return shown(video_, spec_.array.width, spec_.array.height,
               [&](int x, int y) { return engine_.peek(y * spec_.array.width + x, video_.base); });
}

}  // namespace dendro::pixel_planes
