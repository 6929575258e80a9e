#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "models/machines/debuggee.h"

namespace dendro::study {

/// GDB's remote serial protocol without a connection: bytes of GDB in, bytes for GDB out. Packets: ? g G p P m M c s
/// vCont Z0 z0 Z1 z1 k D, the target's description and QStartNoAckMode; all others get the empty answer.
class GdbSession {
 public:
  enum class Ending { kDetached, kKilled, kEnded };

  /// `interrupted` is asked now and then while the program runs; `exit_code` is that of a program that has ended well.
  GdbSession(Debuggee& program, std::function<bool()> interrupted, std::function<std::optional<int>()> exit_code);

  /// What GDB sent, in pieces of any size; the program runs in here. Returns what is to be sent.
  std::string receive(std::string_view bytes);

  /// Set once GDB has let go, has killed the program, or has been told of its end.
  std::optional<Ending> ending() const { return ending_; }

  /// "$TEXT#CHECKSUM".
  static std::string packet(std::string_view text);

 private:
  std::optional<std::string> answer(const std::string& command);
  std::string query(const std::string& command) const;
  std::string all_registers() const;
  std::string one_register(std::string_view number) const;
  std::string write_registers(std::string_view hex);
  std::string write_register(std::string_view text);
  std::string read_memory(std::string_view text) const;
  std::string write_memory(std::string_view text);
  std::string breakpoint(std::string_view text, bool on);
  std::string resume(bool step, std::string_view address);
  std::string stop_reply() const;

  Debuggee& program_;
  std::function<bool()> interrupted_;
  std::function<std::optional<int>()> exit_code_;
  std::string pending_;
  bool acknowledges_ = true;
  Debuggee::Stop stop_ = {Debuggee::kTrap, false};
  std::optional<Ending> ending_;
};

}  // namespace dendro::study
