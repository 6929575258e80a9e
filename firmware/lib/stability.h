#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "firmware/job.h"
#include "firmware/lib/pixel_planes/igc_driver.h"
#include "firmware/lib/rds3000/rds_driver.h"
#include "models/parts/host/host_port.h"
#include "sim/scene/image_io.h"

/// What a hard numerical case is made of; the cases of an algorithm lie below its folder.
namespace dendro::stability {

/// How a measured error is judged.
enum class Bound {
  kAtMost,   ///< passes when measured <= bound
  kMoreThan  ///< passes when measured > bound: a fault that has to show, or the case could not fail
};

/// One measured error beside its bound.
struct Row {
  std::string case_id;  ///< "N-A1", "X2"
  std::string what;     ///< what was measured, one line
  double measured = 0;
  double bound = 0;
  std::string unit;
  std::string reference;  ///< what it was compared with: "gmp", "mpfr", "machine", ...
  Bound kind = Bound::kAtMost;
  std::string where;  ///< the first or worst place: pixel, plane, step; may be empty

  bool pass() const { return kind == Bound::kAtMost ? measured <= bound : measured > bound; }
};

/// A table of numbers that a case leaves as CSV and, with a chart, as a picture.
struct Curve {
  std::string name;  ///< of the files: "N-A4"
  std::string title;
  std::vector<std::string> columns;       ///< names with units; the first is the chart's x
  std::vector<std::vector<double>> rows;  ///< one value per column
  bool logarithmic = false;               ///< the chart's y
  std::string y_label;                    ///< empty: no picture
  double reach = 0;                       ///< above 0: the chart's y goes from 0 to here at least
};

/// A picture that a case leaves as PNG.
struct Picture {
  std::string name;  ///< of the file, without its end
  scene::RgbImage image;
};

struct Result {
  std::vector<Row> rows;
  std::vector<Curve> curves;
  std::vector<Picture> pictures = {};
};

/// How the lines of a pixel array's tree are driven.
struct TreeDrive {
  bool masked = true;
  unsigned gap = 0;            ///< leading zeros of a stream
  int a_late = 0, b_late = 0;  ///< clocks that a line lags its right skew; negative: leads
};

/// A·x + B·y + C, of which `bits` bits are looked at.
struct TreeStream {
  std::int64_t a = 0, b = 0, c = 0;
  unsigned bits = 0;
};

struct TreePixel {
  int x = 0, y = 0;
};

/// A machine at level `function` for the cases of one algorithm.
class Rig {
 public:
  virtual ~Rig() = default;

  /// The same machine with other values of some parameters. Throws UserError for impossible ones.
  virtual std::unique_ptr<Rig> with(const std::map<std::string, std::int64_t>& parameters) const = 0;

  /// Micro-programs by their paths below the repository's root, assembled for a machine that is a pixel array.
  virtual lib::IgcPrograms igc_programs(const std::vector<std::string>& paths) const = 0;

  /// What the tree of a machine that is a pixel array gives these pixels, clock by clock, for streams back to back: by
  /// stream and pixel the `bits` bits as a two's complement number.
  virtual std::vector<std::vector<std::int64_t>> tree(const TreeDrive& drive, const std::vector<TreeStream>& streams,
                                                      const std::vector<TreePixel>& pixels) const = 0;

  /// A microprogram by its path below the repository's root, assembled for the machine.
  virtual lib::ProgramImage program(const std::string& path) const = 0;

  /// Runs the host program on a fresh machine, then shows the machine to `inspect`.
  virtual void run(const std::function<void(HostPort&)>& host_program,
                   const std::function<void(const MachineView&)>& inspect) const = 0;
};

/// One hard case. `run` depends on the rig and the seed alone.
struct Case {
  std::string id;
  std::string what;  ///< one line
  std::function<Result(const Rig&, std::uint64_t seed)> run;
};

}  // namespace dendro::stability
