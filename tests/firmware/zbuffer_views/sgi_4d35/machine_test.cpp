#include <nlohmann/json.hpp>

#include "tests/firmware/zbuffer_views/sgi_4d35/programs.h"

namespace dendro::zbuffer_views {
namespace {

/// One program on the same files under qemu-mips and in every link on the machine.
void expect_the_same_everywhere(const std::string& name, const std::string& job, const std::string& from,
                                const std::string& what, bool all_variants = true) {
  const std::string to = mips::scratch() + "/made", arguments = job + " " + from + " " + to;
  const std::string wanted = made_by(mips::qemu(program(name), arguments), to);
  ASSERT_FALSE(wanted.empty()) << what;
  std::vector<std::string> variants = {""};
  if (all_variants) variants = {"", "-unmapped", "-O1", "-fcr31", "-O1-unmapped"};
  for (const std::string& variant : variants)
    EXPECT_EQ(wanted, made_by(mips::model(program(name + variant), arguments), to)) << what << variant;
  for (const char* variant : {"-O1", "-fcr31"})
    EXPECT_EQ(wanted, made_by(mips::qemu(program(name + variant), arguments), to)) << what << variant;
}

JobFile small_job(const TreeFile& tree) {
  JobFile job(tree);
  job.facts.view_width = 40;
  job.facts.view_height = 48;
  job.facts.width = 24;
  job.facts.height = 32;
  job.facts.centre_x = 11.5f;
  job.facts.centre_y = 15.5f;
  job.facts.scale = 9;
  job.facts.light_width = job.facts.light_height = 32;
  return job;
}

TEST(ZbufferViewsPrograms, ViewsAreTheSameOnTheMachineAndUnderQemu) {
  const TreeFile tree = random_tree(1, 60);
  const std::string tree_path = write_file("tree", tree.bytes());
  for (const std::uint32_t rule : {kZbvInsert, kZbvPeel})
    for (const std::uint32_t side : {kZbvLate, kZbvEarly}) {
      JobFile job = small_job(tree);
      job.facts.rule = rule;
      job.facts.leaf_side = side;
      job.facts.layers = rule == kZbvPeel ? 3 : 2;
      expect_the_same_everywhere("precompute", write_file("job", job.bytes()), tree_path,
                                 "rule " + std::to_string(rule) + " side " + std::to_string(side),
                                 rule != side);
    }
}

TEST(ZbufferViewsPrograms, PicturesAreTheSameOnTheMachineAndUnderQemu) {
  const TreeFile tree = random_tree(2, 60);
  JobFile job = small_job(tree);
  const std::string views = write_file("some_views", precomputed(tree, job));
  job.trees = {{{0, 0, 0}, 0}, {{0.7f, 0.1f, -0.6f}, 77}};
  job.frames = {look({3, 2, 8}, {0.3, 0, 0}, {1, 2, 1}), look({-5, 1, -6}, {0, 0, 0}, {-1, 1, 3})};
  for (std::uint32_t k = 0; k < 16; ++k) {
    job.facts.projection = k & 1 ? kZbvPerspective : kZbvParallel;
    job.facts.scale = k & 1 ? 80 : 9;
    job.facts.options = (k & 2 ? kZbvSkipEmpty : 0) | (k & 4 ? kZbvFullProduct : 0);
    job.facts.shadows = k >> 3;
    expect_the_same_everywhere("reconstruct", write_file("job", job.bytes()), views,
                               "kind " + std::to_string(k), k % 5 == 0);
  }
}

TEST(ZbufferViewsPrograms, PolygonsAreTheSameOnTheMachineAndUnderQemu) {
  const TreeFile tree = random_tree(3, 60);
  JobFile job = small_job(tree);
  job.trees = {{{0, 0, 0}, 0}, {{0.7f, 0.1f, -0.6f}, 77}};
  job.frames = {look({3, 2, 8}, {0.3, 0, 0}, {1, 2, 1}), look({-5, 1, -6}, {0, 0, 0}, {-1, 1, 3})};
  const std::string tree_path = write_file("tree", tree.bytes());
  expect_the_same_everywhere("polygons", write_file("job", job.bytes()), tree_path, "whole");
  job.facts.scale = 60;  // most of the trees is outside
  expect_the_same_everywhere("polygons", write_file("job", job.bytes()), tree_path, "near");
}

TEST(ZbufferViewsPrograms, EmptySamplesDoNotTrap) {
  // The R3010 gives up on denormal numbers: a division by 3.4e38 would trap for every empty sample.
  const TreeFile tree = random_tree(6, 20);
  JobFile job = small_job(tree);
  const std::string views = write_file("some_views", precomputed(tree, job)),
                    json = mips::scratch() + "/run.json", to = mips::scratch() + "/made";
  job.facts.projection = kZbvPerspective;
  job.facts.scale = 80;
  job.facts.shadows = 1;
  made_by(mips::model(program("reconstruct"), write_file("job", job.bytes()) + " " + views + " " + to,
                      "--json " + json),
          to);
  const auto units = nlohmann::json::parse(read_file(json)).at("units").at("sgi_4d35.processor");
  const int others = units.at("exceptions").get<int>() - units.at("tlb_refills").get<int>();
  EXPECT_GT(others, 20) << "calls of the monitor";
  EXPECT_LT(others, 500) << "of 15,360 stored samples";
}

TEST(ZbufferViewsPrograms, DirectionsAreExactAtTies) {
  // N-B1: rational sines are those of the sixths and the half only.
  const int wanted[] = {7, 14, 23, 34, 51, 66, 87, 108, 135, 160, 191};
  for (int n = 2; n <= 12; ++n) {
    const std::string arguments = "--directions " + std::to_string(n),
                      text = std::to_string(n) + " bands, " + std::to_string(wanted[n - 2]) + " views:";
    const Ran ran = mips::run(mips::model(program("precompute"), arguments)),
              qemu = mips::run(mips::qemu(program("precompute"), arguments));
    EXPECT_EQ(0, ran.status) << ran.errors;
    EXPECT_EQ(0u, ran.output.find(text)) << ran.output;
    EXPECT_EQ(qemu.output, ran.output);
  }
}

TEST(ZbufferViewsPrograms, ViewsThatMemoryDoesNotHoldAreReadAgain) {
  const TreeFile tree = random_tree(4, 30);
  JobFile job(tree);
  job.facts.view_width = 720;
  job.facts.view_height = 720;
  job.facts.layers = 2;
  const std::string views = write_file("many_views", precomputed(tree, job));
  job.frames = {look({0, 1, 8}, {0, 0, 0}, {1, 2, 1}), look({0, -5, -3}, {0, 0, 0}, {1, 2, 1}),
                look({0, 1, 8}, {0, 0, 0}, {1, 2, 1})};
  job.facts.options = kZbvSkipEmpty;
  const std::string to = mips::scratch() + "/made",
                    arguments = write_file("job", job.bytes()) + " " + views + " " + to;
  const std::string wanted = made_by(mips::qemu(program("reconstruct"), arguments), to);
  // Seven views of 7.3 MB are needed; the least memory holds three.
  EXPECT_EQ(wanted,
            made_by(mips::model(program("reconstruct"), arguments, "--set memory.main_bytes=33554432"), to));
}

}  // namespace
}  // namespace dendro::zbuffer_views
