#include "firmware/lib/rds3000/overlays.h"

#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "models/machines/rds3000/function.h"
#include "tests/firmware/half_space/program_on_machine.h"

namespace dendro::lib {
namespace {

constexpr std::uint32_t kPage = 4096;
constexpr std::uint32_t kControlStore = 0x800000, kScratchpad = 0x820000;

/// Adds `step` to scratch word 0 and halts; word 1 is its initial data.
ProgramImage adder(const std::string& name, int step) {
  tools::AssembleOptions options;
  const std::string number = std::to_string(step);
  const tools::Ucode ucode =
      tools::assemble("scratch sum[1]; scratch own[1] = {" + number +
                          "};\nreg t = r0;\nentry start;\nstart:\n  t = sum[0];\n  t = t + own[0];\n"
                          "phase_" +
                          name + ":\n  sum[0] = t;\n  halt;\n",
                      name, options)
          .ucode;
  ProgramImage image;
  image.name = name;
  image.words = ucode.words, image.entry = ucode.entry;
  image.symbols = ucode.symbols;
  image.initial_scratch = ucode.scratch_data;
  return image;
}

rds3000::Spec spec_of(std::uint32_t words) {
  rds3000::Spec spec;
  spec.processor.control_store_words = words;
  return spec;
}

/// A machine that has programs loaded and run by overlays, and the pages that were written to.
struct Bench {
  explicit Bench(std::uint32_t words, const MachineOptions& options = {})
      : machine(spec_of(words), options), driver(machine), overlays(driver, words) {}

  /// What the sum grew by.
  std::uint32_t run(const ProgramImage& image) {
    const std::uint32_t before = machine.read(kScratchpad, 0);
    const std::uint32_t entry = overlays.activate(image);
    pages.push_back(entry / kPage);
    driver.start(entry);
    driver.wait();
    return machine.read(kScratchpad, 0) - before;
  }

  rds3000::FunctionEngine machine;
  RdsDriver driver;
  Overlays overlays;
  std::vector<std::uint32_t> pages;
};

TEST(Overlays, InOnePageEachProgramIsLoadedEachTimeItComesBack) {
  const ProgramImage one = adder("one", 1), ten = adder("ten", 10);
  Bench bench(kPage);
  for (int round = 1; round <= 3; ++round) {
    EXPECT_EQ(bench.run(one), 1u);
    EXPECT_EQ(bench.run(ten), 10u);
    EXPECT_EQ(bench.run(ten), 10u) << "still there";
    EXPECT_EQ(bench.overlays.loads(), 2u * round);
  }
}

TEST(Overlays, InAsManyPagesAsProgramsEachIsLoadedOnce) {
  const std::vector<ProgramImage> programs = {adder("a", 1), adder("b", 10), adder("c", 100),
                                              adder("d", 1000)};
  Bench bench(8 * kPage);
  for (int round = 0; round < 3; ++round)
    for (std::size_t i = 0; i < programs.size(); ++i)
      EXPECT_EQ(bench.run(programs[i]), programs[i].initial_scratch.begin()->second) << i;
  EXPECT_EQ(bench.overlays.loads(), 4u);
  EXPECT_EQ(bench.pages, (std::vector<std::uint32_t>{0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3}));
}

TEST(Overlays, TheProgramThatWasNotWantedForTheLongestTimeMakesRoom) {
  const ProgramImage a = adder("a", 1), b = adder("b", 10), c = adder("c", 100);
  Bench bench(2 * kPage);
  bench.run(a), bench.run(b), bench.run(a);
  bench.run(c);  // in the place of b
  EXPECT_EQ(bench.overlays.loads(), 3u);
  EXPECT_EQ(bench.run(a), 1u);
  EXPECT_EQ(bench.overlays.loads(), 3u);
  EXPECT_EQ(bench.run(b), 10u);
  EXPECT_EQ(bench.overlays.loads(), 4u);
  EXPECT_EQ(bench.pages, (std::vector<std::uint32_t>{0, 1, 0, 1, 0, 1}));
}

TEST(Overlays, AProgramThatStayedFindsItsInitialScratchAgain) {
  const ProgramImage a = adder("a", 7), b = adder("b", 10);
  Bench bench(2 * kPage);
  EXPECT_EQ(bench.run(a), 7u);
  EXPECT_EQ(bench.run(b), 10u) << "b's word lies where a's did";
  EXPECT_EQ(bench.run(a), 7u);
  EXPECT_EQ(bench.overlays.loads(), 2u);
}

TEST(Overlays, MarksAreThoseOfTheProgramInThePage) {
  const ProgramImage one = adder("one", 1), ten = adder("ten", 10);
  for (const std::uint32_t words : {kPage, 2 * kPage}) {
    MachineOptions options;
    for (const ProgramImage* image : {&one, &ten})
      options.programs[image->name] = {{image->symbols.at("phase_" + image->name), "phase_" + image->name}};
    Bench bench(words, options);
    bench.run(one), bench.run(ten), bench.run(one);
    std::vector<std::string> names;
    for (const MarkEvent& mark : bench.machine.marks()) names.push_back(mark.name);
    EXPECT_EQ(names, (std::vector<std::string>{"phase_one", "phase_ten", "phase_one"})) << words;
  }
}

TEST(Overlays, APeekSeesWhatTheHostWouldReadAndChangesNothing) {
  Bench bench(kPage);
  bench.machine.write(0x1234 << 1, 0xABCDEF, bps32::kFnLores);
  bench.machine.write(kScratchpad + 5, 77, 0);
  EXPECT_EQ(bench.machine.peek(0x1234 << 1, bps32::kFnLores), 0xABCDEFu);
  EXPECT_EQ(bench.machine.peek(kScratchpad + 5, 0), 77u);
  EXPECT_EQ(bench.machine.peek(kControlStore, 0), bench.machine.read(kControlStore, 0));
}

}  // namespace
}  // namespace dendro::lib
