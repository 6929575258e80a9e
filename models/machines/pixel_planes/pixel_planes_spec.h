#pragma once

#include <cstdint>

#include "sim/config/parameters.h"

namespace dendro::pixel_planes {

/// Everything fixed for a run of a Pixel-Planes machine. Times in picoseconds.
struct Spec {
  struct Array {
    int width = 512, height = 512;  ///< pixels, powers of two
    int memory_bits = 72;           ///< of a pixel
    int ports = 1;                  ///< addresses a clock
  };
  struct Tree {
    bool masked = true;  ///< a start token masks coefficients, so streams may touch
    int gap_clocks = 0;  ///< leading zeros of a stream
  };
  struct Host {
    std::int64_t word_ps = 400000;       ///< a 32-bit word to the machine
    std::int64_t flop_ps = 166667;
    std::int64_t instruction_ps = 1000000;
    std::int64_t program_load_ps = 0;    ///< opening and reading a micro-program, without sending it
    std::int64_t interrupt_ps = 10000000;  ///< from the machine being idle to the host going on
  };
  struct Renderers {
    int count = 1;
    int copy_clocks = 0;  ///< of a copy, behind the clocks in which the tree drains
  };
  struct Frame {
    int width = 0, height = 0;  ///< pixels, whole tiles; 0: none, the arrays' own memory is shown
    bool exists() const { return width > 0; }
  };
  std::int64_t tick_ps = 100000;
  Array array;
  Tree tree;
  Renderers renderers;
  Frame frame;
  int setup_clocks = 4;  ///< of the translator, per expression
  int fifo_words = 512;
  std::int64_t refresh_interval_ps = 0;  ///< one clock is stolen so often; 0: never
  std::int64_t video_interval_ps = 0;
  Host host;

  int levels_x() const;  ///< of the tree: log2(width)
  int levels_y() const;
  int latency() const { return levels_x() + levels_y(); }
  /// Clocks of a copy.
  int copy_words() const { return latency() + renderers.copy_clocks; }
  int pixels() const { return array.width * array.height; }
  /// Streams that are closer than this spill into each other unless `masked`.
  int least_gap() const;
};

/// Reads all parameters. Throws UserError for missing, unknown or impossible ones.
Spec resolve(const config::ParameterSet& parameters);

}  // namespace dendro::pixel_planes
