#include "firmware/half_space/host/hulls_program.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>

#include "firmware/half_space/host/hulls_layout.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/random_hulls.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;

constexpr std::uint32_t kScratchpad = 0x820000;

/// Books what the host program does; the machine is done at once.
class Booked : public HostPort {
 public:
  std::uint32_t read(std::uint32_t, unsigned) override { return 0; }
  void write(std::uint32_t, std::uint32_t, unsigned) override {}
  void dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned,
              std::uint32_t) override {
    if (address >= kScratchpad)
      for (std::size_t i = 0; i < count; ++i)
        scratch[address - kScratchpad + static_cast<std::uint32_t>(i)] = words[i];
  }
  void dma_from(std::uint32_t, std::uint32_t*, std::size_t, unsigned, std::uint32_t) override {}
  void command(std::uint32_t) override {}
  void wait_interrupt() override {
    const auto word = [&](std::uint32_t at) { return scratch.count(at) ? scratch[at] : 0; };
    starts.push_back({word(0), word(1), word(2), word(3), word(4 + kHullFrontCount),
                      HullAction{word(4 + kHullAction)}});
  }
  void compute(const Work& work) override {
    work_.flops += work.flops, work_.instructions += work.instructions;
    work_.program_loads += work.program_loads;
    flops_of[phase_] += work.flops;
  }
  void phase(std::string_view name) override { phase_ = name; }
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }
  void program(std::string_view, std::uint32_t) override {}

  struct Start {
    std::uint32_t x0, y0, x1, y1, fronts;
    HullAction action;
  };
  std::vector<Start> starts;
  std::map<std::uint32_t, std::uint32_t> scratch;
  std::map<std::string, std::uint64_t> flops_of;
  Work work_;

 private:
  std::string phase_;
};

lib::ProgramImage empty_program() {
  lib::ProgramImage image;
  image.name = "test";
  image.scratch = {{"box", {0, 4}}, {"params", {4, kHullParamsWords}}, {"records", {16, 8000}}};
  return image;
}

TEST(HullsProgram, IsLoadedOnceAndStartedToClearAndThenOnceAHull) {
  const PreparedHulls prepared = prepare_hulls(grove(9, 64));
  Booked host;
  run(host, prepared, empty_program());
  EXPECT_EQ(host.work_.program_loads, 1u);
  ASSERT_EQ(host.starts.size(), 10u);
  EXPECT_EQ(host.starts[0].action, HullAction::kClear);
  EXPECT_EQ(host.starts[0].x1, 63u);
  EXPECT_EQ(host.starts[0].y1, 63u);
  for (std::size_t i = 1; i < host.starts.size(); ++i) {
    const PlaneProgram& program = prepared.hulls[i - 1].program;
    EXPECT_EQ(host.starts[i].action, HullAction::kPassesAndMerge);
    EXPECT_EQ(host.starts[i].x0, static_cast<std::uint32_t>(program.box.x0));
    EXPECT_EQ(host.starts[i].fronts, program.front.size());
  }
}

TEST(HullsProgram, TheVaxIsBookedForEverySplitAndEveryPlane) {
  const PreparedHulls few = prepare_hulls(grove(5, 64)), many = prepare_hulls(grove(10, 64));
  Booked a, b;
  run(a, few, empty_program());
  run(b, many, empty_program());
  EXPECT_EQ(a.flops_of["grow"], few.growth.flops);
  EXPECT_GT(few.growth.flops, 30u * 60u) << "30 splits of more than 60 operations";
  EXPECT_GT(b.flops_of["grow"], 3 * a.flops_of["grow"] / 2);
  EXPECT_GT(b.flops_of["set_up"], 3 * a.flops_of["set_up"] / 2);
  EXPECT_GT(a.work_.instructions, 0u) << "look-ups";
}

TEST(HullsProgram, AHullOutsideThePictureIsNotSent) {
  std::mt19937 random(3);
  scene::Scene scene = random_hulls(random, 64, 3);
  scene.objects[1].at = {50, 0, 0};
  Booked host;
  run(host, prepare_hulls(scene), empty_program());
  EXPECT_EQ(host.starts.size(), 1u + 2u);
}

TEST(HullsProgram, RecordsThatDoNotFitTheScratchpadAndASaturatingAdderAreRefused) {
  const PreparedHulls prepared = prepare_hulls(grove(2, 64));
  check_fits(prepared, empty_program(), 8192, {});
  EXPECT_THROW(check_fits(prepared, empty_program(), 32, {}), UserError);
  lib::ProgramImage other = empty_program();
  other.scratch.erase("params");
  EXPECT_THROW(check_fits(prepared, other, 8192, {}), UserError);
  EXPECT_THROW(check_fits(prepare_hulls(with(grove(2, 64), "steep", std::string("saturate"))),
                          empty_program(), 8192, {}),
               UserError);
}

TEST(HullsProgram, CopiesNeedTheThirdRegister) {
  EXPECT_TRUE(needs_three_registers(grove(2)));
  EXPECT_FALSE(needs_three_registers(grove(1)));
  EXPECT_THROW(prepare(grove(2)), UserError);
}

}  // namespace
}  // namespace dendro::half_space
