#include <gtest/gtest.h>

#include <random>

#include "firmware/half_space/host/hulls_layout.h"
#include "firmware/half_space/host/hulls_program.h"
#include "firmware/half_space/host/tree_program.h"
#include "firmware/half_space/reference/colour_model.h"
#include "firmware/half_space/reference/hulls_fixed_point.h"
#include "firmware/half_space/reference/texture_model.h"
#include "firmware/half_space/reference/tree_reference.h"
#include "sim/base/error.h"
#include "tests/firmware/half_space/program_on_machine.h"
#include "tests/firmware/half_space/tree_scenes.h"

namespace dendro::half_space {
namespace {

using namespace testing_scenes;
using namespace testing_programs;

constexpr unsigned kSeed = 56;

lib::ProgramImage program(const std::string& name, const std::string& pack) {
  return assembled("firmware/half_space/rds3000/" + name + ".gia", pack);
}

rds3000::Spec spec_of(bool wide, std::uint32_t control_words = 4096) {
  rds3000::Spec spec;
  spec.memory.cards_per_bank = wide ? 4 : 3;
  spec.processor.control_store_words = control_words;
  return spec;
}

MachineOptions limited() {
  MachineOptions options;
  options.tick_limit = 2'000'000'000;
  return options;
}

Frame frame_of(rds3000::FunctionEngine& machine) {
  Frame frame(kFrame * kFrame);
  for (std::uint32_t y = 0; y < kFrame; ++y)
    machine.dma_from(y << 11, &frame[y * kFrame], kFrame, bps32::kFnLores, 2);
  return frame;
}

/// hulls.gia on a machine whose picture holds random words, beside the model that starts with the same.
class ActionsOf : public ::testing::TestWithParam<const char*> {
 protected:
  ActionsOf()
      : image_(program("hulls", GetParam())),
        machine_(spec_of(false), limited()),
        driver_(machine_),
        hulls_(machine_, driver_, image_),
        model_(kSide, kSide, 255) {
    driver_.load_program(image_);
    for (std::uint32_t& word : model_.picture().pixels) word = random_() & 0xFFFFFF;
    for (std::uint32_t y = 0; y < kSide; ++y)
      machine_.dma_to(y << 11, &model_.picture().pixels[y * kSide], kSide, bps32::kFnLores, 2);
  }

  void expect_same(const std::string& what) {
    for (std::uint32_t y = 0; y < kSide; ++y)
      for (std::uint32_t x = 0; x < kSide; ++x)
        ASSERT_EQ(machine_.read(x << 1 | y << 11, bps32::kFnLores), model_.picture().pixels[y * kSide + x])
            << what << " at " << x << "," << y;
  }

  Box random_box() {
    const int a = number(), b = number(), c = number(), d = number();
    return {std::min(a, b), std::min(c, d), std::max(a, b), std::max(c, d)};
  }

  static constexpr std::uint32_t kSide = 90;
  int number() { return static_cast<int>(random_() % kSide); }

  std::mt19937 random_{kSeed};
  lib::ProgramImage image_;
  rds3000::FunctionEngine machine_;
  lib::RdsDriver driver_;
  HullsDriver hulls_;
  HullsModel model_;
};

TEST_P(ActionsOf, PassesMergesTrunksAndPaintedTrunksLeaveEveryWordAsTheModelDoes) {
  int marked = 0;
  for (int i = 0; i < 12; ++i) {
    SCOPED_TRACE("seed " + std::to_string(kSeed) + " round " + std::to_string(i));
    const PreparedHulls prepared = prepare_hulls(random_hulls(random_, kSide, 2));
    const PlaneProgram &crown = prepared.hulls[0].program, &trunk = prepared.hulls[1].program;
    hulls_.draw(crown, HullAction::kPasses), model_.passes(crown);
    expect_same("passes");
    const std::optional<Box> left = hulls_.box_left();
    ASSERT_TRUE(left);
    hulls_.merge(crown, *left), model_.merge(crown.box);
    expect_same("merge of the box that is left, against that of the whole first box");
    const Box other = random_box();
    hulls_.merge(crown, other), model_.merge(other);
    hulls_.draw(trunk, HullAction::kTrunk), model_.passes(trunk), model_.merge_trunk(trunk.box);
    expect_same("trunk");
    if (i % 3 == 0) hulls_.clear(kSide, kSide, 255), model_.clear();
    Trapezium trapezium;
    trapezium.box = random_box();
    trapezium.left = number() - 30, trapezium.right = trapezium.left + number() / 2.0;
    trapezium.left_step = (number() - 45) / 40.0, trapezium.right_step = (number() - 45) / 40.0;
    hulls_.paint(trapezium, 255), model_.paint(trapezium);
    expect_same("painter");
    for (const std::uint32_t word : model_.picture().pixels) marked += word >> kNearestLow == kTrunkMark;
  }
  EXPECT_GT(marked, 3000) << "trunks should be seen";
}

TEST_P(ActionsOf, AnEmptyHullLeavesNoBox) {
  PreparedHulls prepared = prepare_hulls(random_hulls(random_, kSide, 2));
  PlaneProgram program = prepared.hulls[0].program;
  program.boxing = true;
  for (PlaneRecord& record : program.back)
    record.wide = false, record.start = record.step_x = record.step_y = 0;
  hulls_.draw(program, HullAction::kPasses);
  EXPECT_FALSE(hulls_.box_left());
  model_.passes(program);
  expect_same("empty");
}

INSTANTIATE_TEST_SUITE_P(Packing, ActionsOf, ::testing::Values("none", "full"));

struct Drawn {
  Frame before_colour, after;
  std::uint64_t loads = 0;
};

/// The machine as the host sees it, its program loads counted.
class Counting : public rds3000::FunctionEngine {
 public:
  using FunctionEngine::FunctionEngine;
  void compute(const Work& work) override { loads += work.program_loads; }
  std::uint64_t loads = 0;
};

Drawn draw(const PreparedTree& tree, const std::string& pack, std::uint32_t control_words = 4096) {
  const TreePrograms programs{program("hulls", pack), program("roughen", pack), program("texture", pack),
                              program("colour", pack)};
  Counting machine(spec_of(tree.texture.wide, control_words), limited());
  const CubeBytes cube = tree.textured() ? make_texture(tree.texture) : CubeBytes{};
  Drawn drawn;
  run(machine, tree, programs, cube, {control_words, false},
      [&] { drawn.before_colour = frame_of(machine); });
  drawn.after = frame_of(machine);
  drawn.loads = machine.loads;
  return drawn;
}

/// The frame with the cube where the texture program leaves it, and the picture above it.
void expect_exact(const PreparedTree& tree, const Drawn& drawn, const std::string& what) {
  const FixedPointPicture hulls = run_tree_fixed_point(tree);
  Frame wanted(kFrame * kFrame, 0);
  if (tree.textured()) {
    const CubeBytes cube = make_texture(tree.texture);
    for (std::size_t k = 0; k < cube.size(); ++k)
      for (std::size_t i = 0; i < cube[k].size(); ++i)
        wanted[tree.layout.levels[k].base + i] |= std::uint32_t{cube[k][i]} << 8 * tree.layout.levels[k].byte;
  }
  for (int y = 0; y < hulls.height; ++y)
    for (int x = 0; x < hulls.width; ++x)
      wanted[static_cast<std::size_t>(y) * kFrame + x] |=
          hulls.pixels[static_cast<std::size_t>(y) * hulls.width + x];
  for (std::size_t p = 0; p < wanted.size(); ++p)
    ASSERT_EQ(drawn.before_colour[p], wanted[p])
        << what << " before colouring, at " << p % kFrame << "," << p / kFrame;
  if (!tree.textured()) return;
  colour_model(tree.colouring, wanted);
  for (std::size_t p = 0; p < wanted.size(); ++p)
    ASSERT_EQ(drawn.after[p], wanted[p]) << what << " at " << p % kFrame << "," << p / kFrame;
}

TEST(TreeMicrocode, EveryWordOfTheFrameOfRandomCompleteTreesIsThatOfTheIntegerModels) {
  std::mt19937 random(kSeed + 1);
  const char* const kTrunks[] = {"cylinder", "painter", "cone", "none"};
  std::int64_t trunk = 0;
  for (int i = 0; i < 8; ++i) {
    const bool wide = i % 2 == 1;
    scene::Scene scene = random_tree(random, kTrunks[i % 4], 70 + static_cast<int>(random() % 60), i % 3);
    if (kTrunks[i % 4] == std::string("none")) scene.objects[0].trunk_parameters.clear();
    scene = with(scene, "cube_bits", std::int64_t{4});
    scene = with(scene, "texture", std::string(i % 4 < 2 ? "chunks" : i == 7 ? "none" : "fbm"));
    if (i % 3 != 2) scene = with(scene, "roughness", 0.1 + 0.05 * i);
    if (i % 4 == 0) scene = with(scene, "texture_from", std::string("host"));
    const PreparedTree tree = prepare_tree(scene, wide ? 32 : 24);
    const std::string what = "seed " + std::to_string(kSeed) + " scene " + std::to_string(i);
    const Drawn drawn = draw(tree, i % 2 == 0 ? "none" : "full");
    expect_exact(tree, drawn, what);
    for (const std::uint32_t word : run_tree_fixed_point(tree).pixels)
      trunk += word >> kNearestLow == kTrunkMark;
  }
  EXPECT_GT(trunk, 400) << "trunks should be seen";
}

TEST(TreeMicrocode, AGroveOfRoughCrownsNeedsALoadForEachStepUnlessTheControlStoreHoldsAll) {
  scene::Scene scene = grove(3, 96);
  scene.objects[0] = with_trunk(scene.objects[0], {{"trunk", std::string("painter")}});
  scene = with(with(with(scene, "roughness", 0.2), "texture", std::string("chunks")), "cube_bits",
               std::int64_t{4});
  const PreparedTree tree = prepare_tree(scene, 24);
  const Drawn taking_turns = draw(tree, "none"), together = draw(tree, "none", 32768);
  expect_exact(tree, taking_turns, "taking turns");
  EXPECT_EQ(taking_turns.after, together.after);
  EXPECT_EQ(taking_turns.loads, 1u + 1 + 2 * 3 + 1)
      << "texture, hulls, each crown's roughening and merge, colour";
  EXPECT_EQ(together.loads, 4u);
}

TEST(TreeMicrocode, ACubeFromTheHostGivesThePictureOfTheMachineS) {
  std::mt19937 random(kSeed + 2);
  const scene::Scene scene = with(with(random_tree(random, "cylinder", 80, 0), "texture", std::string("fbm")),
                                  "cube_bits", std::int64_t{4});
  const Drawn made = draw(prepare_tree(scene, 24), "full");
  const Drawn sent = draw(prepare_tree(with(scene, "texture_from", std::string("host")), 24), "full");
  EXPECT_EQ(made.after, sent.after);
  EXPECT_EQ(made.loads, sent.loads + 1);
}

}  // namespace
}  // namespace dendro::half_space
