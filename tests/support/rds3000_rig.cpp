#include "tests/support/rds3000_rig.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdlib>

#include "models/machines/rds3000/clocked.h"
#include "models/machines/rds3000/cycle.h"
#include "models/machines/rds3000/function.h"
#include "models/parts/ik11b/ik11b_shell.h"
#include "sim/base/sha256.h"

namespace dendro::test {
namespace {

using namespace rds3000;

template <class Word>
std::string digest(const std::vector<Word>& words) {
  return base::sha256({reinterpret_cast<const char*>(words.data()), words.size() * sizeof(Word)}).substr(0, 16);
}

void add_processor(std::vector<std::string>& out, const ProcessorState& p) {
  for (unsigned i = 0; i < p.ram.size(); ++i) out.push_back(fmt::format("ram{} {:08x}", i, p.ram[i]));
  out.push_back(fmt::format("q {:08x}", p.q));
  out.push_back(fmt::format("flags z{} n{} c{} v{} ds{} host{}", p.z, p.n, p.c, p.v, p.divide_sign, p.host_flag));
  out.push_back(fmt::format("pc {:03x} page {} counter {:03x} depth {}", p.pc, p.page, p.counter, p.depth));
  for (unsigned i = 0; i < p.depth; ++i) out.push_back(fmt::format("stack{} {:03x}", i, p.stack[i]));
  out.push_back(fmt::format("sar {:04x} bus_address {:06x}", p.sar, p.bus_address));
  out.push_back(fmt::format("write_data {:08x} read_data {:08x}", p.write_data, p.read_data));
  out.push_back(fmt::format("multiplier {:04x} {:04x} {:08x} in {}", p.mul_x, p.mul_y, p.product, p.product_in));
  out.push_back(fmt::format("running {}", p.running));
  for (unsigned i = 0; i < 64 && i < p.scratch.size(); ++i) out.push_back(fmt::format("scratch{} {:08x}", i, p.scratch[i]));
  out.push_back("scratch " + digest(p.scratch));
  out.push_back("control " + digest(p.control));
}

void add_devices(std::vector<std::string>& out, const dr64::Core& memory, const video::State& video) {
  const dr64::State& m = memory.state();
  out.push_back("pixels " + digest(m.pixels));
  out.push_back(fmt::format("masks {:08x} {:08x} {:08x}", m.mask_word, m.mask_lores, m.mask_hires));
  out.push_back("lut " + digest(std::vector<std::uint32_t>(video.lut.begin(), video.lut.end())));
  out.push_back("crossbar " + digest(std::vector<std::uint8_t>(video.crossbar.begin(), video.crossbar.end())));
  out.push_back(fmt::format("luvo {:08x}", video.luvo_crossbar));
  for (unsigned i = 0; i < video.fbc.size(); ++i) out.push_back(fmt::format("fbc{} {:08x}", i, video.fbc[i]));
}

void add_timing(std::vector<std::string>& out, const Engine& engine, std::int64_t end) {
  const ProcessorCounters& p = engine.processor_counters();
  const BusCounters& b = engine.bus_counters();
  const MemoryCounters& m = engine.memory_counters();
  out.push_back(fmt::format("end {}", end));
  for (const MarkEvent& mark : engine.marks()) out.push_back(fmt::format("mark {} {}", mark.name, mark.tick));
  for (const RunInterval& run : engine.runs()) out.push_back(fmt::format("ran {} {}", run.from, run.to));
  out.push_back(fmt::format("busy {}", p.busy));
  out.push_back(fmt::format("stalls host {} branch {} data {} bus {} scratch {}", p.stall_host, p.stall_branch,
                            p.stall_data, p.stall_bus, p.stall_scratch));
  out.push_back(fmt::format("idle {}", p.idle));
  out.push_back(fmt::format("bus {} reads {} writes {} host {} {}", b.busy, b.processor_reads, b.processor_writes,
                            b.host_reads, b.host_writes));
  out.push_back(fmt::format("memory access {} video {} refresh {}", m.busy_access, m.busy_video, m.busy_refresh));
  out.push_back(fmt::format("memory reads {} writes {} masked {} wait {}", m.reads, m.writes, m.masked_writes,
                            m.wait_ticks));
  out.push_back(fmt::format("fetches {} refreshes {}", m.fetches, m.refreshes));
  out.push_back(fmt::format("time_dependent {}", engine.time_dependent()));
}

Outcome run_timed(Level level, const Spec& spec, const MachineOptions& options, const HostProgram& program) {
  sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
  std::unique_ptr<Engine> engine;
  if (level == Level::kClocked) {
    engine = std::make_unique<ClockedEngine>("rds3000", spec, options);
  } else {
    engine = std::make_unique<CycleEngine>(spec, options);
  }
  engine->set_marks(options.marks);
  ik11b::Shell shell("host", spec.host, *engine, program);
  sc_core::sc_start();
  if (shell.error()) std::rethrow_exception(shell.error());
  const std::int64_t end = (shell.ended_ps() + spec.processor.tick_ps - 1) / spec.processor.tick_ps;
  engine->finish(end);
  Outcome out;
  out.time_dependent = engine->time_dependent();
  add_processor(out.state, engine->processor());
  add_devices(out.state, engine->memory(), engine->video());
  add_timing(out.timing, *engine, end);
  return out;
}

Outcome run_function(const Spec& spec, const MachineOptions& options, const HostProgram& program) {
  FunctionEngine engine(spec, options);
  program(engine);
  Outcome out;
  out.time_dependent = engine.time_dependent();
  add_processor(out.state, engine.processor());
  add_devices(out.state, engine.devices().memory, engine.devices().video);
  return out;
}

std::string serialise(const Outcome& outcome) {
  std::string text = outcome.time_dependent ? "1\n" : "0\n";
  for (const std::string& line : outcome.state) text += "s" + line + "\n";
  for (const std::string& line : outcome.timing) text += "t" + line + "\n";
  return text;
}

Outcome parse(const std::string& text) {
  Outcome out;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find('\n', at)) != std::string::npos; at = end + 1) {
    const std::string line = text.substr(at, end - at);
    if (line[0] == 's') out.state.push_back(line.substr(1));
    if (line[0] == 't') out.timing.push_back(line.substr(1));
    if (line[0] == '1') out.time_dependent = true;
  }
  return out;
}

}  // namespace

Outcome run_rds3000(Level level, const Spec& spec, const MachineOptions& options, const HostProgram& program) {
  int ends[2];
  if (pipe(ends) != 0) std::abort();
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    std::string text;
    try {
      text = serialise(level == Level::kFunction ? run_function(spec, options, program)
                                                 : run_timed(level, spec, options, program));
    } catch (const std::exception& error) {
      text = std::string("0\ns") + "error " + error.what() + "\n";
    }
    for (std::size_t at = 0; at < text.size();) {
      const ssize_t n = ::write(ends[1], text.data() + at, text.size() - at);
      if (n <= 0) std::_Exit(1);
      at += static_cast<std::size_t>(n);
    }
    std::_Exit(0);
  }
  close(ends[1]);
  std::string text;
  char buffer[4096];
  for (ssize_t n; (n = ::read(ends[0], buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the simulation's process died";
  return parse(text);
}

std::string first_difference(const std::vector<std::string>& a, const std::vector<std::string>& b) {
  for (std::size_t i = 0; i < std::max(a.size(), b.size()); ++i) {
    const std::string left = i < a.size() ? a[i] : "(nothing)", right = i < b.size() ? b[i] : "(nothing)";
    if (left != right) return left + "  |  " + right;
  }
  return "";
}

}  // namespace dendro::test
