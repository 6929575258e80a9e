#include <benchmark/benchmark.h>

#include <memory>

#include "firmware/tools/assembler.h"
#include "models/machines/pixel_planes/clocked.h"
#include "models/machines/pixel_planes/pixel_planes_map.h"
#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/devices.h"
#include "models/machines/rds3000/function.h"
#include "models/parts/am2903/am2903.h"
#include "models/parts/am2903/am2903_slices.h"
#include "models/parts/bps32/bps32_isa.h"
#include "models/parts/dr64/dr64_timing.h"
#include "models/parts/ik11b/ik11b_isa.h"
#include "sim/study/run.h"
#include "tests/support/tape.h"

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

// 512 x 512 pixels compare a plane with 16 bits of memory and store it, over and over; items are clocks. SystemC runs
// once per process.
void pixel_planes_at_clocked(benchmark::State& state) {
  using igc::Function;
  using igc::Operand;
  std::vector<igc::MicroWord> program(10);
  program[0].function = Function::kSetEnable;
  program[1].function = Function::kLoad;
  for (const int at : {2, 5}) {
    program[at].loop = igc::LoopCount::kFraction;
    program[at + 1].loop = igc::LoopCount::kNumber, program[at + 1].loop_number = 16;
    program[at].tree = program[at + 1].tree = program[at].loop_end = program[at + 1].loop_end = true;
    program[at + 1].indexed_a = true;
    program[at + 1].x = Operand::kTree, program[at + 1].y = Operand::kPortA;
  }
  program[3].read_a = true;
  program[3].function = Function::kBorrow;
  program[4].function = Function::kAndCarry;
  program[6].write_a = true;
  program[7].end = true;
  pixel_planes::Spec spec;
  spec.setup_clocks = 0;
  spec.host.word_ps = 1;
  const std::unique_ptr<Machine> machine = pixel_planes::make_clocked(spec, {});
  igc::Header header;
  header.fraction = 10;
  header.expression = true;
  for (auto _ : state)
    machine->run([&](HostPort& host) {
      for (std::uint32_t i = 0; i < 2 * program.size(); ++i)
        host.write(i, static_cast<std::uint32_t>(igc::pack(program[i / 2]) >> (i % 2 * 32)), 0);
      for (std::uint32_t plane = 0; plane < 10000; ++plane) {
        // Small numbers in single precision, different in every plane.
        const std::uint32_t words[] = {igc::pack(header), 0x3E000000 + (plane << 8), 0xBE800000 - (plane << 7), 0x45000000 + plane};
        host.dma_to(pixel_planes::kFifo, words, 4, 0);
      }
    });
  state.SetItemsProcessed(machine->cycles());
  state.counters["busy"] = static_cast<double>(machine->instructions()) / static_cast<double>(machine->cycles());
}
BENCHMARK(pixel_planes_at_clocked)->Iterations(1)->Unit(benchmark::kMillisecond);

// The 200 trees of 12 planes of FG86 6.3, 14.4 ms of the machine's time; argument 1: tiles that cannot be seen are left.
void grove_on_pixel_planes(benchmark::State& state) {
  const study::Catalogue all{{pixel_planes::pixel_planes_type()}, study::algorithms(), ""};
  study::RunArguments arguments;
  arguments.scene = "grove";
  arguments.machine = "pixel-planes";
  const study::RunRequest request = study::prepare_run(all, arguments);
  Tape tape;
  request.algorithm->make(request.file.scene, *request.type, request.preset.parameters)->run(tape);
  pixel_planes::Device device(pixel_planes::resolve(request.preset.parameters), state.range(0) != 0);
  for (auto _ : state) {
    for (const auto& [address, value] : tape.words) device.write(address, value);
    benchmark::DoNotOptimize(device.peek(0, 0));
  }
}
BENCHMARK(grove_on_pixel_planes)->Arg(0)->Arg(1)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace dendro

BENCHMARK_MAIN();
