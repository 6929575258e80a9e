#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "models/parts/host/host_port.h"
#include "sim/base/check.h"
#include "sim/base/scratch_file.h"

namespace dendro {

/// A machine after its run, as a debugger and the monitor show it: no time passes, nothing changes.
struct MachineView {
  std::function<std::uint32_t(std::uint32_t address, unsigned function)> peek;
  int width = 0;  ///< of what the monitor shows
  int height = 0;
  const std::uint8_t* rgb = nullptr;  ///< 8-bit RGB, rows top down, width * height * 3 bytes
};

/// The simulated picture against the algorithm's double-precision reference.
struct ErrorReport {
  std::string reference = "double";
  std::optional<double> psnr_db;    ///< none: the pictures are identical
  double max_depth_error = 0;       ///< units of the depth register
  std::int64_t wrong_pixels = 0;    ///< covered in one but not in the other, or another face
  std::int64_t covered_pixels = 0;  ///< in the reference
  std::vector<std::pair<std::string, double>> extra;  ///< further figures of the algorithm, by name
};

/// One channel of the measuring picture (EXR): width * height values, row 0 on top. Colour is named R, G, B,
/// depth Z; names with a dot form EXR layers ("cost.visits").
struct Layer {
  std::string name;
  std::vector<float> values;
};

/// A microprogram that the job loads.
struct FirmwareImage {
  std::string name;                              ///< "half_space/rds3000/half_space (pack full)"
  std::string sha256;                            ///< of its .ucode text
  std::map<std::string, std::uint32_t> symbols;  ///< control-store addresses by label
};

/// One scene prepared for one algorithm on one machine: what the host program does and how good the result
/// is. The constructor of an implementation checks the scene and throws UserError; after that nothing is the
/// user's fault.
class Job {
 public:
  virtual ~Job() = default;

  /// The host program. Called once, at every level the same.
  virtual void run(HostPort& host) = 0;

  /// Compares what the machine holds and shows with the reference.
  virtual ErrorReport compare(const MachineView& machine) const = 0;

  /// Channels of image.exr: at least R, G, B and Z; size is that of the scene's picture.
  virtual std::vector<Layer> layers(const MachineView& machine) const = 0;

  /// Absolute paths of the files that were read for this job, meshes and their parts, sorted; the scene file
  /// is not among them.
  virtual std::vector<std::string> input_files() const = 0;

  virtual std::vector<FirmwareImage> firmware() const = 0;

  /// Facts of the prepared scene that tables need, by name: "planes.front", "planes.back", "planes.edge_on",
  /// ...
  virtual std::vector<std::pair<std::string, double>> facts() const = 0;
};

/// A machine with an operating system of its own, as a job sees it: files by name, and programs that read and write them.
class Workstation {
 public:
  virtual ~Workstation() = default;

  /// A file of the workstation, empty until somebody writes it.
  virtual std::vector<std::uint8_t>& file(const std::string& name) = 0;

  /// The same of a file that may be too large for the memory of this process. No file() has its name.
  virtual base::ScratchFile& large_file(const std::string& name) = 0;

  /// Runs a program to its end. Untimed it runs at `function` whatever the level of the run, and its phases take no time.
  /// Throws UserError with what it said when it ends with anything but 0.
  virtual void run(const std::string& program, const std::vector<std::string>& arguments, bool timed) = 0;

  /// An untimed run for the sake of one large file, or that file as an earlier run of the same program left it. `made_from` tells apart
  /// all inputs that matter to the file; a kept file that is not `good` is made again.
  virtual void make(const std::string& program, const std::vector<std::string>& arguments, const std::string& file,
                    const std::string& made_from, const std::function<bool(const base::ScratchFile&)>& good) = 0;

  /// One finished picture of a sequence, 8-bit RGB, rows top down.
  virtual void show(int width, int height, const std::vector<std::uint8_t>& rgb) = 0;

  /// Puts a file into the folder of the run's results.
  virtual void keep(const std::string& name, const base::ScratchFile& file) = 0;
};

/// A job for a machine whose programs are files: it has no host computer.
class ProgramJob : public Job {
 public:
  /// What the user of the workstation does. Called once.
  virtual void run_programs(Workstation& workstation) = 0;

  void run(HostPort&) final { DENDRO_CHECK(false, "this machine has no host computer"); }

  /// The phase that begins with mark `label` (call 0x7002); empty: none.
  virtual std::string phase_name(std::uint32_t label) const = 0;

  /// Size and bytes of the picture that compare() looks at, 8-bit RGB, rows top down; after run().
  virtual int width() const = 0;
  virtual int height() const = 0;
  virtual const std::vector<std::uint8_t>& rgb() const = 0;
};

}  // namespace dendro
