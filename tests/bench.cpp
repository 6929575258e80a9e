#include <benchmark/benchmark.h>

#include <memory>

#include "firmware/tools/assembler.h"
#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/function.h"
#include "models/parts/am2903/am2903.h"
#include "models/parts/am2903/am2903_slices.h"
#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/dr64/dr64_timing.h"
#include "models/parts/ik11b/ik11b_isa.h"

// Host time of the parts that the levels' speed rests on. Whole runs are measured by `dendro bench`.
namespace dendro {
namespace {

void alu_in_word_arithmetic(benchmark::State& state) {
  am2903::Input in{0x12345678, 0x9ABCDEF0, 1, false, false, false};
  for (auto _ : state) {
    in.s = am2903::operate({bps32::kRam, bps32::kRPlusS, false, 0}, in).y;
    benchmark::DoNotOptimize(in.s);
  }
}
BENCHMARK(alu_in_word_arithmetic);

void alu_in_eight_slices(benchmark::State& state) {
  am2903::SliceInputs in;
  in.r = 0x12345678;
  in.func = bps32::kRPlusS;
  in.dest = bps32::kRam;
  for (auto _ : state) {
    in.s = am2903::evaluate_slices(in).y;
    benchmark::DoNotOptimize(in.s);
  }
}
BENCHMARK(alu_in_eight_slices);

void memory_grant_under_video(benchmark::State& state) {
  dr64::Spec spec;
  dr64::Timing timing(spec, 200000);
  const video::State video = video::power_on(video::DisplayMode::kLores30);
  timing.set_fetches({video::raster_of(video, {}, spec.fetch_bits), 0, 0, 200000});
  const dr64::Work pixel{true, 7, false};
  std::int64_t tick = 0;
  for (auto _ : state) tick = timing.grant(tick + 6, pixel, false);
  benchmark::DoNotOptimize(tick);
}
BENCHMARK(memory_grant_under_video);

void microcode_loop_at_function(benchmark::State& state) {
  const tools::Assembly program = tools::assemble(
      "reg x = r0; reg z = r1; reg d = r2; reg n = r3;\nentry start;\nstart:\n  n = 20000;\nloop_head:\n  z = z + d;\n"
      "  bus_x = x = x + 2;\n  read lores;\n  n = n - 1 -> flags;\n  if (!zero) goto loop_head;\n  halt;\n",
      "bench.gia");
  rds3000::FunctionEngine machine(rds3000::Spec{}, {});
  for (std::size_t i = 0; i < program.ucode.words.size(); ++i)
    for (unsigned half = 0; half < 2; ++half)
      machine.write(rds3000::kControlStore + static_cast<std::uint32_t>(2 * i + half),
                    static_cast<std::uint32_t>(program.ucode.words[i] >> (32 * half)), 0);
  for (const auto& [address, word] : program.ucode.scratch_data)
    machine.write(rds3000::kScratchpad + address, word, 0);
  machine.write(rds3000::kProcessor, program.ucode.entry << 16, 0);
  for (auto _ : state) {
    machine.command(ik11b::kRun | ik11b::kReset);
    machine.command(ik11b::kRun);
    machine.wait_interrupt();
  }
  state.SetItemsProcessed(static_cast<std::int64_t>(machine.words()));
}
BENCHMARK(microcode_loop_at_function);

}  // namespace
}  // namespace dendro

BENCHMARK_MAIN();
