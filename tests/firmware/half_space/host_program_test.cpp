#include "firmware/half_space/host/host_program.h"

#include <gtest/gtest.h>

#include <map>
#include <utility>

#include "firmware/half_space/job.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

/// A machine that remembers every word by address, and draws with the fixed-point model when it is let run:
/// it knows only what the host program sent.
class FakeMachine : public HostPort {
 public:
  std::uint32_t read(std::uint32_t address, unsigned) override { return words_[address]; }
  void write(std::uint32_t address, std::uint32_t value, unsigned function) override {
    EXPECT_EQ(function, 0u);
    words_[address] = value;
    log_.push_back("write");
  }
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
              std::uint32_t step) override {
    EXPECT_EQ(function, 0u);
    for (std::size_t i = 0; i < count; ++i) words_[address + static_cast<std::uint32_t>(i) * step] = words[i];
    log_.push_back("dma");
  }
  void dma_from(std::uint32_t, std::uint32_t*, std::size_t, unsigned, std::uint32_t) override {
    ADD_FAILURE();
  }
  void command(std::uint32_t bits) override {
    commands_.push_back(bits);
    log_.push_back("command");
  }
  void wait_interrupt() override {
    ASSERT_EQ(commands_, (std::vector<std::uint32_t>{03000, 01000})) << "reset and run, then run";
    draw();
    log_.push_back("wait");
  }
  void compute(const Work& work) override { loads_ += work.program_loads, flops_ += work.flops; }
  void phase(std::string_view name) override { log_.push_back("phase " + std::string(name)); }
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }
  void program(std::string_view, std::uint32_t) override {}

  std::uint32_t word(std::uint32_t address) const {
    const auto found = words_.find(address);
    return found == words_.end() ? 0 : found->second;
  }

  MachineView view(int width, int height) {
    rgb_.clear();
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        for (unsigned channel = 0; channel < 3; ++channel) {
          std::uint32_t index = 0;
          for (unsigned k = 0; k < 8; ++k)
            index |= (pixel(x, y) >> word(0xC20000 + 8 * channel + k) & 1u) << k;
          rgb_.push_back(static_cast<std::uint8_t>((word(0x830000 + index) >> 10 * channel & 0x3FF) >> 2));
        }
      }
    return {[this](std::uint32_t address, unsigned function) {
              EXPECT_EQ(function, 2u);
              return pixel(static_cast<int>(address >> 1 & 511), static_cast<int>(address >> 11));
            },
            width, height, rgb_.data()};
  }

  std::vector<std::string> log_;
  std::vector<std::uint32_t> commands_;
  std::uint64_t loads_ = 0, flops_ = 0;

 private:
  std::uint32_t pixel(int x, int y) const {
    return static_cast<std::size_t>(x) < 512 && y < picture_.height && x < picture_.width
               ? picture_.pixels[static_cast<std::size_t>(y) * picture_.width + x]
               : 0;
  }

  PlaneRecord decode(std::uint32_t& at) {
    PlaneRecord record;
    const std::uint32_t descriptor = word(at + 3);
    record.wide = (descriptor & 4) != 0;
    const auto number = [&](int i) {
      if (!record.wide) return std::int64_t{static_cast<std::int32_t>(word(at + i))};
      return static_cast<std::int64_t>(std::uint64_t{word(at + i + 4)} << 32 | word(at + i));
    };
    record.start = number(0), record.step_x = number(1), record.step_y = number(2);
    record.kind = static_cast<PlaneKind>(descriptor & 3);
    record.face = static_cast<int>(descriptor >> 8 & 255);
    at += record.wide ? 8 : 4;
    return record;
  }

  void draw() {
    PlaneProgram program;
    program.width = static_cast<int>((word(0xC00001) & 0xFFFF) + 1);
    program.height = static_cast<int>((word(0xC00001) >> 16) + 1);
    const std::uint32_t box = 0x820000 + 16, params = 0x820000 + 20;
    program.box = {static_cast<int>(word(box)), static_cast<int>(word(box + 1)),
                   static_cast<int>(word(box + 2)), static_cast<int>(word(box + 3))};
    program.maxdepth = static_cast<int>(word(params));
    std::uint32_t at = 0x820000 + 32;
    for (auto [records, count] : {std::pair(&program.back, word(params + 2)),
                                  {&program.edge_on, word(params + 3)},
                                  {&program.front, word(params + 4)}})
      for (std::uint32_t i = 0; i < count; ++i) records->push_back(decode(at));
    picture_ = run_fixed_point(program);
  }

  std::map<std::uint32_t, std::uint32_t> words_;
  FixedPointPicture picture_;
  std::vector<std::uint8_t> rgb_;
};

ProgramImage image() {
  ProgramImage result;
  result.name = "half_space.ucode";
  result.words = {0x0123456789ABCDEF, 0xFEDCBA9876543210};
  result.entry = 0x123;
  result.scratch = {{"box", {16, 4}}, {"params", {20, 5}}, {"records", {32, 8160}}};
  result.initial_scratch = {{0, 7}, {3, 9}, {4000, 11}};
  return result;
}

TEST(HostProgram, LoadsThenRunsThenWaitsInItsPhases) {
  FakeMachine machine;
  const Prepared prepared = prepare(icosahedron());
  run(machine, prepared, image());
  EXPECT_EQ(machine.log_,
            (std::vector<std::string>{"phase load_program", "dma", "dma", "dma", "phase load_planes", "dma",
                                      "dma", "dma", "phase load_tables", "dma", "dma", "write", "write",
                                      "write", "command", "command", "phase finish", "wait", "command"}));
  EXPECT_EQ(machine.loads_, 1u);
  EXPECT_EQ(machine.flops_, prepared.setup_flops);
}

TEST(HostProgram, ControlStoreTakesTheLowHalfOfAWordFirst) {
  FakeMachine machine;
  run(machine, prepare(icosahedron()), image());
  EXPECT_EQ(machine.word(0x800000), 0x89ABCDEFu);
  EXPECT_EQ(machine.word(0x800001), 0x01234567u);
  EXPECT_EQ(machine.word(0x800002), 0x76543210u);
}

TEST(HostProgram, InitialScratchDataArriveAtTheirAddresses) {
  FakeMachine machine;
  run(machine, prepare(icosahedron()), image());
  EXPECT_EQ(machine.word(0x820000), 7u);
  EXPECT_EQ(machine.word(0x820003), 9u);
  EXPECT_EQ(machine.word(0x820000 + 4000), 11u);
}

TEST(HostProgram, SetsRestartAddressViewportAndCrossbars) {
  FakeMachine machine;
  scene::Scene scene = icosahedron();
  scene.image.height = 300;
  run(machine, prepare(scene), image());
  EXPECT_EQ(machine.word(0x850000), 0x123u << 16);
  EXPECT_EQ(machine.word(0xC00001), 511u | 299u << 16);
  EXPECT_EQ(machine.word(0x830400), 0x24u);
  for (unsigned line = 0; line < 34; ++line)
    EXPECT_EQ(machine.word(0xC20000 + line), line < 24 ? 12 + line % 8 : line) << line;
}

TEST(HostProgram, PassesBoxAndParameters) {
  FakeMachine machine;
  const Prepared prepared = prepare(with(icosahedron(), "boxing", false));
  run(machine, prepared, image());
  const Box& box = prepared.program.box;
  const std::uint32_t wanted[] = {std::uint32_t(box.x0),
                                  std::uint32_t(box.y0),
                                  std::uint32_t(box.x1),
                                  std::uint32_t(box.y1),
                                  4095,
                                  0,
                                  8,
                                  4,
                                  8};
  for (unsigned i = 0; i < 9; ++i) EXPECT_EQ(machine.word(0x820010 + i), wanted[i]) << i;
  FakeMachine boxing;
  run(boxing, prepare(icosahedron()), image());
  EXPECT_EQ(boxing.word(0x820015), 1u);
}

TEST(LookUpTable, HoldsTenBitShadesByFaceNumberInEveryPage) {
  const std::vector<std::uint32_t> table = look_up_table({{0, 0, 1}, {255, 128, 64}});
  ASSERT_EQ(table.size(), 1024u);
  for (const std::uint32_t page : {0u, 256u, 512u, 768u}) {
    EXPECT_EQ(table[page], 4u << 20);
    EXPECT_EQ(table[page + 1], 1023u | 514u << 10 | 257u << 20);
    EXPECT_EQ(table[page + 255], table[page]) << "unused face numbers look like the background";
  }
}

TEST(CheckFits, RefusesMoreRecordsThanTheScratchpadHolds) {
  const Prepared prepared = prepare(icosahedron());  // 20 plain records, 80 words
  ProgramImage program = image();
  EXPECT_NO_THROW(check_fits(prepared, program, 32 + 80, {}));
  EXPECT_THROW(check_fits(prepared, program, 32 + 79, {}), UserError);
  const Prepared wide = prepare(pine(32));
  ASSERT_GT(wide.program.wide_records(), 0u);
  const auto words = static_cast<std::uint32_t>(32 * 4 + 4 * wide.program.wide_records());
  EXPECT_NO_THROW(check_fits(wide, program, 32 + words, {}));
  EXPECT_THROW(check_fits(wide, program, 32 + words - 1, {}), UserError);
}

TEST(CheckFits, RefusesMicroprogramsWithoutTheAreasOrTheAdder) {
  const Prepared prepared = prepare(icosahedron());
  for (const char* area : {"box", "params", "records"}) {
    ProgramImage program = image();
    program.scratch.erase(area);
    EXPECT_THROW(check_fits(prepared, program, 8192, {}), UserError) << area;
  }
  const Prepared saturating = prepare(with(icosahedron(), "steep", std::string("saturate")));
  ProgramImage program = image();
  EXPECT_THROW(check_fits(saturating, program, 8192, {}), UserError);
  program.scratch["params"].size = 6;
  EXPECT_NO_THROW(check_fits(saturating, program, 8192, {}));
}

TEST(Job, DrawsWhatTheReferenceDrawsFromNothingButTheWordsSent) {
  for (const scene::Scene& scene : {icosahedron(), pine(16)}) {
    FakeMachine machine;
    const std::unique_ptr<Job> job = make_job(scene, image());
    job->run(machine);
    const ErrorReport report = job->compare(machine.view(512, 512));
    EXPECT_EQ(extra(report, "wrong_pixels_far"), 0);
    EXPECT_LT(report.max_depth_error, 1.0);
    EXPECT_GT(report.covered_pixels, 60000);
    ASSERT_TRUE(report.psnr_db);
    EXPECT_GT(*report.psnr_db, 30.0);
  }
}

TEST(Job, KnowsItsFilesItsFactsAndItsLayers) {
  FakeMachine machine;
  const std::unique_ptr<Job> job = make_job(icosahedron(), image());
  job->run(machine);
  EXPECT_TRUE(job->input_files().empty());
  EXPECT_EQ(make_job(pine(16), image())->input_files().size(), 1u);
  const std::vector<std::pair<std::string, double>> facts = job->facts();
  EXPECT_EQ(std::map(facts.begin(), facts.end()).at("planes.edge_on"), 4.0);
  for (const Layer& layer : job->layers(machine.view(512, 512)))
    EXPECT_EQ(layer.values.size(), 512u * 512u) << layer.name;
}

}  // namespace
}  // namespace dendro::half_space
