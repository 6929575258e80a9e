#pragma once

#include <cstdint>
#include <map>
#include <random>
#include <string>
#include <vector>

#include "firmware/tools/igc_assembler.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/parts/igc/igc.h"

/// The shipped micro-programs on a small array, without a host program.
namespace dendro::pixel_planes {

struct Layout {
  unsigned bits = 16;
  bool scratch = false;  ///< a fourth field behind the colour

  std::map<std::string, unsigned> registers() const {
    return {{"depth_bits", bits},      {"front", 0},           {"back", bits}, {"nearest", 2 * bits},
            {"colour", 3 * bits}, {"scratch", 3 * bits + 24}, {"index", 3 * bits + 24}};
  }
};

/// The text of a source that ships in firmware/half_space/pixel_planes.
std::string shipped_source(const std::string& name);

Spec small_spec(int side = 64, int ports = 1, int memory_bits = 128);

/// half_space.igc, and with two ports two_ports.igc behind it: entries by name.
class Programs {
 public:
  explicit Programs(int ports);

  unsigned entry(const std::string& program) const { return entries_.at(program).entry; }
  const std::vector<std::uint64_t>& words() const { return words_; }
  const std::map<std::string, tools::IgcProgram>& all() const { return entries_; }
  unsigned register_number(const std::string& name) const { return registers_.at(name); }
  igc::ControllerState controller(const Layout& layout) const;

 private:
  std::vector<std::uint64_t> words_;
  std::map<std::string, tools::IgcProgram> entries_;
  std::map<std::string, unsigned> registers_;
};

/// A command of the shipped programs.
struct Step {
  std::string program;
  igc::Command command;
};

Step step(const Programs& programs, const std::string& program, std::uint64_t constant = 0);
Step step(const Programs& programs, const std::string& program, std::int64_t a, std::int64_t b, std::int64_t c,
          unsigned fraction, unsigned guard, std::uint64_t constant = 0);

/// Guard bits that hold A·x + B·y + C of an array of `side` pixels squared.
unsigned guard_of(std::int64_t a, std::int64_t b, std::int64_t c, int side, unsigned fraction, unsigned bits);

/// Pictures of random hulls: planes in all directions, steep and flat ones, some that just touch the corner of a tile.
std::vector<Step> random_stream(std::mt19937_64& random, const Programs& programs, const Layout& layout, int side,
                                int hulls);

}  // namespace dendro::pixel_planes
