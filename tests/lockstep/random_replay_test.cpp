#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <systemc>

#include "models/machines/rds3000/boundaries.h"
#include "models/machines/rds3000/cycle.h"
#include "models/machines/rds3000/host_recorder.h"
#include "sim/study/worker.h"
#include "tests/lockstep/random_microprogram.h"

/// Records random machines running random programs, and replays each unit alone at both levels.
namespace dendro::rds3000 {
namespace {

using test::Flavour;
using test::RandomRun;

std::uint64_t setting(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text ? std::strtoull(text, nullptr, 10) : fallback;
}

struct Window {
  std::int64_t from = 0, to = INT64_MAX;
};

// The trace of one boundary, or empty when the program hit the limit; in a process of its own.
std::string record(const RandomRun& run, const std::string& boundary, const Window& window, Window* ran = nullptr) {
  const std::string reply = study::run_in_worker([&]() -> std::string {
    sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
    trace::Writer writer(boundary, window.from, window.to, false);
    MachineOptions options;
    options.tick_limit = 1 << 17;
    options.recorder = &writer;
    CycleEngine engine(run.spec, options);
    HostRecorder host(writer, run.spec, engine);
    const bool at_host = boundary == kHostBoundary;
    ik11b::Target& target = at_host ? static_cast<ik11b::Target&>(host) : engine;
    ik11b::Shell shell("host", run.spec.host, target, [&](HostPort& port) {
      if (at_host)
        host.run(port, run.host);
      else
        run.host(port);
    });
    sc_core::sc_start();
    if (shell.error()) return "";
    const std::int64_t last = (shell.ended_ps() + run.spec.processor.tick_ps - 1) / run.spec.processor.tick_ps;
    engine.finish(last);
    trace::Header header;
    header.machine = "rds3000";
    header.boundary = boundary;
    const RunInterval interval = engine.runs().empty() ? RunInterval{0, last} : engine.runs().back();
    return std::to_string(interval.from) + " " + std::to_string(interval.to) + "\n" + writer.file(header);
  });
  if (reply.empty()) return "";
  const std::size_t line = reply.find('\n');
  if (ran) *ran = {std::stoll(reply), std::stoll(reply.substr(reply.find(' ')))};
  return reply.substr(line + 1);
}

std::string replay_of(const RandomRun& run, const std::string& bytes, Level level) {
  return study::run_in_worker([&] {
    trace::Reader reader(bytes, "trace");
    for (const trace::Boundary& boundary : boundaries())
      if (boundary.name == reader.header().boundary) reader.expect(boundary);
    return replay(run.spec, level, reader).difference.value_or("");
  });
}

void record_and_replay(std::uint64_t salt, bool windows) {
  const bool one = std::getenv("DENDRO_SEED") != nullptr;
  const std::uint64_t first = setting("DENDRO_SEED", salt), count = one ? 1 : setting("DENDRO_PROGRAMS", 25);
  int replayed = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const RandomRun run = test::random_run(seed, Flavour{true, seed % 2 == 0});
    for (const char* boundary : {kFrameMemoryBoundary, kProcessorBoundary, kHostBoundary}) {
      SCOPED_TRACE(std::string(boundary) + ", repeat with DENDRO_SEED=" + std::to_string(seed));
      Window window, ran;
      std::string bytes = record(run, boundary, window, &ran);
      if (bytes.empty()) break;
      if (windows) {
        std::mt19937_64 random(seed);
        const std::int64_t length = ran.to - ran.from;
        window.from = ran.from - 30 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(length + 30));
        window.to = window.from + 1 + static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(2 * length));
        bytes = record(run, boundary, window);
      }
      for (const Level level : {Level::kCycle, Level::kClocked}) {
        SCOPED_TRACE(level_name(level));
        ASSERT_EQ("", replay_of(run, bytes, level)) << "window " << window.from << " to " << window.to;
        ++replayed;
      }
    }
  }
  EXPECT_TRUE(one || replayed > static_cast<int>(count)) << "too many programs had no end";
}

TEST(RandomReplay, EveryUnitAloneDoesWhatItDidInItsMachine) { record_and_replay(3000, false); }

TEST(RandomReplay, SoItDoesFromTheMiddleOfARun) { record_and_replay(700000, true); }

}  // namespace
}  // namespace dendro::rds3000
