#pragma once

#include <map>
#include <string>
#include <vector>

#include "firmware/job.h"
#include "sim/study/exec_services.h"
#include "sim/study/progress.h"
#include "sim/study/run.h"

namespace dendro::study {

/// The bytes of a program that ships with dendro: "zbuffer_views_polygons" is embedded as "mips/zbuffer_views_polygons.elf.hex".
std::string shipped_program(const std::string& name);

/// Runs a program on a fresh machine; `program` is its name in messages. Throws UserError when it does not end with 0.
ProgramResult run_elf(const MachineType& type, const config::ParameterSet& parameters, Level level, const MachineOptions& options,
                      const std::string& program, const std::string& bytes, const std::vector<std::string>& arguments,
                      MemoryServices& services);

/// A machine whose programs are ELF files, as a job uses it in one run: files in memory, what programs took is added up.
class ElfWorkstation : public Workstation {
 public:
  /// Pictures and kept files go into `folder` unless it is empty.
  ElfWorkstation(const RunRequest& request, const ProgramJob& job, std::string folder, Progress* progress);

  std::vector<std::uint8_t>& file(const std::string& name) override { return files_[name]; }
  base::ScratchFile& large_file(const std::string& name) override { return large_files_[name]; }
  void run(const std::string& program, const std::vector<std::string>& arguments, bool timed) override;
  void make(const std::string& program, const std::vector<std::string>& arguments, const std::string& file, const std::string& made_from,
            const std::function<bool(const base::ScratchFile&)>& good) override;
  void show(int width, int height, const std::vector<std::uint8_t>& rgb) override;
  void keep(const std::string& name, const base::ScratchFile& file) override;

  /// Joins the pictures that were shown, if there were several, to animation.gif.
  void finish();

  double clock_hz() const { return clock_hz_; }
  std::int64_t cycles() const { return cycles_; }
  std::uint64_t instructions() const { return instructions_; }  ///< of the timed programs
  const std::vector<Phase>& phases() const { return phases_; }  ///< "program.phase", each once, in the order of their first time
  const std::vector<UnitStats>& units() const { return units_; }
  const std::vector<std::string>& notes() const { return notes_; }  ///< what a reader of the run should know

 private:
  void add(const std::string& program, const ProgramResult& result, const std::vector<MemoryServices::Mark>& calls);
  void add_phase(const std::string& name, std::int64_t cycles);

  const RunRequest& request_;
  const ProgramJob& job_;
  const std::string folder_;
  Progress* progress_;
  MemoryServices::Files files_;
  MemoryServices::LargeFiles large_files_;
  std::vector<std::string> pictures_;
  double clock_hz_ = 0;
  std::int64_t cycles_ = 0;
  std::uint64_t instructions_ = 0;
  std::vector<Phase> phases_;
  std::vector<UnitStats> units_;
  std::vector<std::string> notes_;
};

}  // namespace dendro::study
