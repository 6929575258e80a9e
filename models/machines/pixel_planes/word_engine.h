#pragma once

#include <cstdint>
#include <vector>

#include "models/machines/pixel_planes/flag_regions.h"
#include "models/machines/pixel_planes/macro.h"
#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/machines/pixel_planes/pixel_planes_state.h"
#include "models/machines/pixel_planes/tile_kernels.h"
#include "sim/base/check.h"

namespace dendro::pixel_planes {

struct WordCounters {
  std::uint64_t pixel_operations = 0;   ///< macro-operations times pixels
  std::uint64_t evaluated = 0;          ///< of these, carried out one by one
  std::uint64_t bitwise_commands = 0;   ///< carried out clock by clock: no macro-operation
};

/// The pixel array for `function` and `cycle`: fields are numbers, commands are macro-operations on them. Micro-programs
/// that are no macro-operation run clock by clock on the bits; with `lazy` only where a flag that gates them can be set. With `lazy`, tiles in which a hull provably cannot be seen
/// are left for later: what stands for their scratch fields is the list of operations since these were last overwritten
/// whole, and a tile is brought up to date when something of it is read.
class WordEngine {
 public:
  WordEngine(const Spec& spec, bool lazy);

  /// A command at its entry; the registers are those of `controller`.
  void execute(const MacroProgram& program, const igc::Command& command, const igc::ControllerState& controller);

  /// Bits low to low + 31 of a pixel; 0 beyond the memory.
  std::uint32_t peek(int pixel, unsigned low);

  /// All memory as bit planes. E, C and D are not kept.
  const ArrayState& bits();

  /// The memory before the first command: zeros unless it is changed here.
  ArrayState& before_first() {
    DENDRO_CHECK(fields_.empty() && bits_current_, "{} fields", fields_.size());
    return bits_;
  }

  const WordCounters& counters() const { return counters_; }

 private:
  struct Field {
    FieldPlace place;
    std::vector<TileField> tiles;
  };

  /// A macro-operation whose fields are numbers of fields_.
  struct Op {
    Macro macro;
    int field[3] = {-1, -1, -1};
  };

  /// Operations that begin with overwriting some fields in every pixel: `overwritten` is the set of those.
  struct Batch {
    std::vector<Op> ops;
    std::uint32_t overwritten = 0;
  };

  struct Interval {
    std::int64_t low = 0, high = 0;
  };

  struct Square {
    int tile_x = 0, tile_y = 0, tiles_x = 1, tiles_y = 1;
  };

  void execute_bits(const MacroProgram& program, const igc::Command& command, const igc::ControllerState& controller);
  bool add(const Macro& macro);
  int field_of(const FieldPlace& place, bool flag);
  void flush();
  void flush_square(const Square& square, int batch);
  bool touches_scratch_only(const Batch& batch, const Square& square) const;
  Interval depth_of(const Macro& macro, const Square& square) const;
  Interval sum_of(const Macro& macro, const Square& square) const;
  void run(const Batch& batch, int tile);
  void catch_up(int tile);
  void catch_up_all();
  void to_bits();
  void load(Field& field) const;
  void save(const Field& field);
  std::size_t tile_of(int pixel, std::size_t& inside) const;

  Spec spec_;
  bool lazy_;
  int tiles_x_, tiles_y_;
  ArrayState bits_;
  FlagRegions flags_;
  std::vector<Field> fields_;
  bool bits_current_ = true;      ///< bits_ holds what the fields hold
  std::vector<Batch> batches_;    ///< those that some tile still waits for, and the open one at the end
  std::vector<int> waiting_;      ///< per tile: number in batches_, or -1
  std::vector<TileOp> tile_ops_;
  WordCounters counters_;
};

}  // namespace dendro::pixel_planes
