#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "models/parts/host/host_port.h"

namespace dendro::lib {

/// A named stretch of the scratchpad.
struct ScratchArea {
  std::uint32_t address = 0;
  std::uint32_t size = 0;
};

/// A microprogram as the host's driver loads it: the content of a .ucode file.
struct ProgramImage {
  std::string name;
  std::string sha256;                                      ///< of the .ucode text
  std::vector<std::uint64_t> words;                        ///< control store from address 0
  std::uint32_t entry = 0;                                 ///< page in bits 12-14, address in bits 0-11
  std::map<std::string, std::uint32_t> symbols;            ///< control-store addresses by label
  std::map<std::string, ScratchArea> scratch;              ///< areas by name
  std::map<std::uint32_t, std::uint32_t> initial_scratch;  ///< word by scratch address
};

/// The RDS-3000's boards through its host interface, as the VAX's driver uses them. Costs are the machine's:
/// each call is one or more accesses of the port.
class RdsDriver {
 public:
  explicit RdsDriver(HostPort& host) : host_(host) {}

  /// Opens the program (one program load of host software), sends control store and initial scratch data. The
  /// program goes to the page of 4,096 words; start it with its entry point in that page.
  void load_program(const ProgramImage& image, std::uint32_t page = 0);

  /// The scratchpad's words as the program wants them at its start.
  void write_initial_scratch(const ProgramImage& image);

  void write_scratch(std::uint32_t address, const std::vector<std::uint32_t>& words);

  /// `count` scratchpad words from `address` on.
  std::vector<std::uint32_t> read_scratch(std::uint32_t address, std::size_t count);

  /// 1,024 entries: red bits 0-9, green 10-19, blue 20-29.
  void write_look_up_table(const std::vector<std::uint32_t>& entries);

  /// Sends pixel lines low..low+7 to the address bits of all three channels' tables.
  void show_byte(unsigned low);

  /// Sends pixel lines 0..7 to the address bits of the red channel's table, 8..15 to green's, 16..23 to blue's.
  void show_colour();

  /// Makes the monitor show the top left width x height pixels of the lores frame. `repeat_field`: the display mode
  /// shows every line in both fields, and its viewport counts them twice [BRL-C, mode 1].
  void set_viewport(int width, int height, bool repeat_field);

  /// Resets the processor to the entry point and starts it.
  void start(std::uint32_t entry);

  /// Waits for the completion interrupt and takes the run bit back.
  void wait();

 private:
  void route(const std::vector<std::uint32_t>& lines);

  HostPort& host_;
};

}  // namespace dendro::lib
