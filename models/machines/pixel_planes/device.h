#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "models/machines/machine.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/word_engine.h"
#include "models/parts/igc/igc.h"
#include "sim/base/error.h"

namespace dendro::pixel_planes {

/// Gathers command words until a command is whole.
class CommandDecoder {
 public:
  std::optional<igc::Command> add(std::uint32_t word);
  bool empty() const { return words_.empty(); }

 private:
  std::vector<std::uint32_t> words_;
};

/// What the host sees behind its addresses, without time: control store, video registers, and commands that are carried
/// out when their last word comes.
class Device {
 public:
  Device(const Spec& spec, bool lazy) : spec_(spec), engine_(spec, lazy) {}

  /// A command and the words that its program sends.
  struct Done {
    igc::Command command;
    std::uint64_t words = 1;
    unsigned program_words = 0;  ///< of the control store, from the entry on
  };

  /// Throws UserError for a command whose program has no end, or sends no word.
  std::optional<Done> write(std::uint32_t address, std::uint32_t value);

  /// Control store and video registers; 0 elsewhere.
  std::uint32_t read(std::uint32_t address) const;

  /// What a host that waits for a machine whose last command lacks words would wait for.
  static UserError never_idle();
  bool lacks_words() const { return !decoder_.empty(); }

  Picture picture();
  std::uint32_t peek(std::uint32_t pixel, unsigned low) {
    return pixel < static_cast<std::uint32_t>(spec_.pixels()) ? engine_.peek(static_cast<int>(pixel), low) : 0;
  }
  WordEngine& engine() { return engine_; }
  const VideoState& video() const { return video_; }
  const igc::ControllerState& controller() const { return controller_; }

  /// What the array is sent for a command that has just been carried out.
  std::vector<igc::ArrayWord> words_of(const igc::Command& command) const;

  /// Registers as a command would write them, before the first command.
  void set_register(unsigned number, unsigned value) { controller_.registers.at(number) = static_cast<std::uint8_t>(value); }

 private:
  Done carry_out(const igc::Command& command);

  Spec spec_;
  igc::ControllerState controller_;
  CommandDecoder decoder_;
  WordEngine engine_;
  VideoState video_;
  std::map<unsigned, MacroProgram> programs_;  ///< by entry, until the store is written
};

}  // namespace dendro::pixel_planes
