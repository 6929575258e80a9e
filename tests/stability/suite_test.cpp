#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "firmware/half_space/stability/cases.h"
#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/base/error.h"
#include "sim/study/algorithms.h"
#include "sim/study/stability.h"

namespace dendro::study {
namespace {

using stability::Bound;
using stability::Result;
using stability::Row;
using Json = nlohmann::json;

Catalogue catalogue() { return {{rds3000::rds3000_type(), pixel_planes::pixel_planes_type(), sgi_4d35::sgi_4d35_type()}, algorithms(), ""}; }

std::vector<Result> run(const std::vector<StabilitySuite>& suites, const std::vector<std::string>& cases,
                        std::uint64_t seed = 1) {
  StabilityOptions options;
  options.cases = cases;
  options.seed = seed;
  options.jobs = 2;
  return run_stability(catalogue(), suites, options, nullptr);
}

int failures(const Result& result) {
  int failed = 0;
  for (const Row& row : result.rows) failed += !row.pass();
  return failed;
}

/// Hands everything through but turns bit 0 of every word that a DMA brings to the host.
class TurningPort : public HostPort {
 public:
  explicit TurningPort(HostPort& port) : port_(port) {}
  std::uint32_t read(std::uint32_t a, unsigned f) override { return port_.read(a, f); }
  void write(std::uint32_t a, std::uint32_t v, unsigned f) override { port_.write(a, v, f); }
  void dma_to(std::uint32_t a, const std::uint32_t* w, std::size_t n, unsigned f,
              std::uint32_t step) override {
    port_.dma_to(a, w, n, f, step);
  }
  void dma_from(std::uint32_t a, std::uint32_t* w, std::size_t n, unsigned f, std::uint32_t step) override {
    port_.dma_from(a, w, n, f, step);
    for (std::size_t i = 0; i < n; ++i) w[i] ^= 1;
  }
  void command(std::uint32_t bits) override { port_.command(bits); }
  void wait_interrupt() override { port_.wait_interrupt(); }
  void compute(const Work& work) override { port_.compute(work); }
  void phase(std::string_view name) override { port_.phase(name); }
  std::uint32_t peek(std::uint32_t a, unsigned f) const override { return port_.peek(a, f); }
  void program(std::string_view name, std::uint32_t first) override { port_.program(name, first); }

 private:
  HostPort& port_;
};

/// A machine with a fault: in every second run a column of the image memory has a face number off by one bit,
/// and every DMA to the host a wrong bit.
class FaultyRig : public stability::Rig {
 public:
  explicit FaultyRig(const stability::Rig& sound) : sound_(sound) {}

  std::unique_ptr<Rig> with(const std::map<std::string, std::int64_t>& p) const override { return sound_.with(p); }
  lib::ProgramImage program(const std::string& path) const override { return sound_.program(path); }
  lib::IgcPrograms igc_programs(const std::vector<std::string>& p) const override { return sound_.igc_programs(p); }
  std::vector<std::vector<std::int64_t>> tree(const stability::TreeDrive& drive,
                                              const std::vector<stability::TreeStream>& streams,
                                              const std::vector<stability::TreePixel>& pixels) const override {
    return sound_.tree(drive, streams, pixels);
  }

  void run(const std::function<void(HostPort&)>& host_program,
           const std::function<void(const MachineView&)>& inspect) const override {
    const bool odd = runs_++ % 2 != 0;
    sound_.run(
        [&](HostPort& port) {
          TurningPort turning(port);
          host_program(turning);
        },
        [&](const MachineView& view) {
          MachineView faulty = view;
          faulty.peek = [&](std::uint32_t address, unsigned function) {
            const std::uint32_t column = address >> 1 & 0x3FF;
            return view.peek(address, function) ^ (odd && column == 60 ? 0x1000u : 0u);
          };
          inspect(faulty);
        });
  }

 private:
  const stability::Rig& sound_;
  mutable int runs_ = 0;
};

/// A pixel array with a fault: bit 3 of what is read from a column of pixels, and of what the tree gives them, is wrong.
class FaultyArray : public stability::Rig {
 public:
  explicit FaultyArray(const stability::Rig& sound) : sound_(sound) {}
  explicit FaultyArray(std::unique_ptr<stability::Rig> sound) : owned_(std::move(sound)), sound_(*owned_) {}

  std::unique_ptr<Rig> with(const std::map<std::string, std::int64_t>& p) const override {
    return std::make_unique<FaultyArray>(sound_.with(p));
  }
  lib::ProgramImage program(const std::string& path) const override { return sound_.program(path); }
  lib::IgcPrograms igc_programs(const std::vector<std::string>& p) const override { return sound_.igc_programs(p); }
  std::vector<std::vector<std::int64_t>> tree(const stability::TreeDrive& drive,
                                              const std::vector<stability::TreeStream>& streams,
                                              const std::vector<stability::TreePixel>& pixels) const override {
    auto values = sound_.tree(drive, streams, pixels);
    for (auto& stream : values)
      for (std::size_t p = 0; p < pixels.size(); ++p) stream[p] ^= pixels[p].x == kColumn ? 8 : 0;
    return values;
  }
  void run(const std::function<void(HostPort&)>& host_program,
           const std::function<void(const MachineView&)>& inspect) const override {
    sound_.run(host_program, [&](const MachineView& view) {
      MachineView faulty = view;
      faulty.peek = [&](std::uint32_t pixel, unsigned low) {
        return view.peek(pixel, low) ^ (pixel % 512 == kColumn ? 8u : 0u);
      };
      inspect(faulty);
    });
  }

 private:
  static constexpr int kColumn = 60;
  std::unique_ptr<stability::Rig> owned_;
  const stability::Rig& sound_;
};

/// The real cases on the faulty machine.
std::vector<StabilitySuite> faulty_suites() {
  std::vector<StabilitySuite> suites = stability_suites();
  for (StabilitySuite& suite : suites)
    for (stability::Case& one : suite.cases)
      one.run = [sound = one.run, array = suite.machine != "rds3000:fg86"](const stability::Rig& rig, std::uint64_t seed) {
        return array ? sound(FaultyArray(rig), seed) : sound(FaultyRig(rig), seed);
      };
  return suites;
}

class Faulty : public ::testing::TestWithParam<const char*> {};

TEST_P(Faulty, EveryCaseFailsOnAMachineWithAFaultAndSaysWhere) {
  const auto results = run(faulty_suites(), {GetParam()});
  ASSERT_EQ(1u, results.size());
  EXPECT_GT(failures(results[0]), 0);
  EXPECT_FALSE(all_pass(results));
  bool placed = false;
  const std::string wanted = std::string(GetParam()) == "N-A10" ? "step " : "pixel (60, ";
  for (const Row& row : results[0].rows)
    placed = placed || (!row.pass() && row.where.find(wanted) != std::string::npos);
  EXPECT_TRUE(placed) << stability_text(results);
}

INSTANTIATE_TEST_SUITE_P(Cases, Faulty,
                         ::testing::Values("N-A1", "N-A2", "N-A3", "N-A4", "N-A5", "N-A6", "N-A7", "N-A8", "N-A9",
                                           "N-A10", "X1", "X2", "X3",
                                           "X4", "X6", "N-P1", "N-P2", "N-P3", "N-P4"),
                         [](const auto& tested) {
                           std::string name = tested.param;
                           name.erase(std::remove(name.begin(), name.end(), '-'), name.end());
                           return name;
                         });

TEST(SuiteLong, EveryBoundHoldsForOtherSeeds) {
  for (const std::uint64_t seed : {2u, 3u}) {
    const auto results = run(stability_suites(), {}, seed);
    std::size_t cases = 0;
    for (const StabilitySuite& suite : stability_suites()) cases += suite.cases.size();
    EXPECT_EQ(cases, results.size());
    EXPECT_TRUE(all_pass(results)) << "dendro stability --seed " << seed << "\n" << stability_text(results);
  }
}

TEST(Suite, ABoundIsJudgedByItsRelation) {
  EXPECT_TRUE((Row{"a", "", 1, 1, "", "", Bound::kAtMost, ""}.pass()));
  EXPECT_FALSE((Row{"a", "", 1.01, 1, "", "", Bound::kAtMost, ""}.pass()));
  EXPECT_FALSE((Row{"a", "", 1, 1, "", "", Bound::kMoreThan, ""}.pass()));
  EXPECT_FALSE((Row{"a", "", std::nan(""), 1, "", "", Bound::kAtMost, ""}.pass()));
  EXPECT_FALSE(all_pass({{{{"a", "", 2, 1, "", "", Bound::kAtMost, ""}}, {}}}));
}

TEST(Suite, ResultsSurviveThePipeAndJsonHasTheContractsKeys) {
  Result result;
  result.rows.push_back({"N-Z1", "what, \"quoted\"", 0.5, 1, "units", "gmp", Bound::kAtMost, "pixel (1, 2)"});
  result.curves.push_back({"c", "t", {"x", "y"}, {{1, std::nan("")}, {2, 4}}, true, "y"});
  const Result back = result_from_bytes(to_bytes(result));
  EXPECT_EQ(stability_json({result}), stability_json({back}));
  EXPECT_EQ("\"x\",\"y\"\n1,\n2,4\n", curve_csv(back.curves.at(0)));
  const Json json = Json::parse(stability_json({back}));
  EXPECT_EQ(1, json["schema"]);
  EXPECT_EQ("stability", json["command"]);
  for (const char* key : {"case", "measured", "bound", "unit", "pass", "reference", "what"})
    EXPECT_TRUE(json["rows"][0].contains(key)) << key;
  EXPECT_EQ(true, json["rows"][0]["pass"]);
}

TEST(Suite, AnUnknownCaseIsTheUsersErrorAndNamesTheKnownOnes) {
  try {
    run(stability_suites(), {"N-A99"});
    FAIL();
  } catch (const UserError& error) {
    EXPECT_NE(std::string::npos, std::string(error.what()).find("N-A10")) << error.what();
  }
}

}  // namespace
}  // namespace dendro::study
