#pragma once

#include <gtest/gtest.h>

#include <unistd.h>

#include <cmath>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>

#include "sim/base/embedded.h"
#include "sim/base/error.h"
#include "sim/study/run.h"

/// A machine whose time is a formula of its parameters, and an algorithm that fits it, so that studies can be
/// tested against sums done by hand.
namespace dendro::study::fake {

inline const base::EmbeddedFile kPreset{
    "fake/machine/plain.toml",
    "[clock]\n"
    "hz = { value = 1000.0, source = \"by decree\" }\n"
    "[delay]\n"
    "a_ticks = { value = 10, range = [5, 30], source = \"ASSUMED DEV-001\" }\n"
    "b_ticks = { value = 4, range = [4, 8], source = \"ASSUMED DEV-002\" }\n"
    "c_ticks = { follows = \"delay.b_ticks\", source = \"ASSUMED DEV-003\" }\n"
    "[rate]\n"
    "words_per_s = { value = 100.0, range = [50.0, 200.0], scale = \"log\", source = \"ASSUMED DEV-004\" }\n"
    "[mode]\n"
    "kind = { value = \"plain\", choices = [\"plain\", \"dense\"], source = \"ASSUMED DEV-005\" }\n"};

inline const base::EmbeddedFile kScene{"fake/algorithm/scenes/toy.toml",
                                       "description = \"a toy\"\n"
                                       "algorithm = \"toy\"\n"
                                       "[image]\nwidth = 2\nheight = 1\n"
                                       "[camera]\nheight = 1.0\n"
                                       "[[object]]\nplanes = [[1, 0, 0, 1]]\n"};

class FakeMachine : public Machine {
 public:
  FakeMachine(const config::ParameterSet& set, Level level) : level_(level) {
    config::ParameterReader reader(set);
    hz_ = reader.real("clock.hz", 1, 1e9);
    const auto a = reader.integer("delay.a_ticks", 0, 1000), b = reader.integer("delay.b_ticks", 0, 1000);
    const auto c = reader.integer("delay.c_ticks", 0, 1000);
    const double rate = reader.real("rate.words_per_s", 1, 1e6);
    const bool dense = reader.choice("mode.kind", {"plain", "dense"}) == "dense";
    reader.finish();
    if (dense && c > 6) reader.impossible("delay.c_ticks", "too slow for dense words");
    load_ = std::llround(hz_ / rate * 10);
    scan_ = dense ? a + b + c : 2 * (a + b + c);
  }

  void run(const std::function<void(HostPort&)>&) override { ran_ = true; }
  double clock_hz() const override { return hz_; }
  std::int64_t cycles() const override { return level_ == Level::kFunction ? 0 : load_ + scan_; }
  std::int64_t machine_cycles() const override { return level_ == Level::kFunction ? 0 : scan_; }
  std::uint64_t instructions() const override { return static_cast<std::uint64_t>(scan_); }
  std::vector<Phase> phases() const override {
    if (level_ == Level::kFunction) return {};
    return {{"load", load_, true}, {"scan", scan_, false}};
  }
  std::vector<UnitStats> units() const override {
    if (level_ == Level::kFunction) return {};
    const auto total = static_cast<std::uint64_t>(load_ + scan_), busy = static_cast<std::uint64_t>(scan_);
    return {{"fake.unit", {{"cycles", total}, {"busy", busy}, {"idle", total - busy}}}};
  }
  std::vector<MarkEvent> marks() const override { return {}; }
  std::vector<std::string> elaborated() const override { return {"fake.unit"}; }
  bool time_dependent() const override { return false; }
  Picture picture() const override {
    EXPECT_TRUE(ran_);
    return {2, 1, {1, 2, 3, 4, 5, 6}};
  }
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }

 private:
  Level level_;
  double hz_ = 1;
  std::int64_t load_ = 0, scan_ = 0;
  bool ran_ = false;
};

class FakeJob : public Job {
 public:
  explicit FakeJob(const scene::Scene& scene) {
    scene::Options options = scene.options;
    crash_ = options.boolean("crash", false);
    kill_ = options.boolean("kill", false);
    options.finish();
    for (const scene::Object& o : scene.objects)
      if (!o.mesh.empty()) files_.push_back(o.mesh);
  }
  void run(HostPort&) override {}
  ErrorReport compare(const MachineView& machine) const override {
    EXPECT_EQ(6, machine.rgb[5]);
    if (crash_) std::abort();
    if (kill_) ::kill(::getppid(), SIGKILL);
    ErrorReport report;
    report.covered_pixels = 2;
    return report;
  }
  std::vector<Layer> layers(const MachineView&) const override {
    return {{"R", {0, 0}}, {"G", {0, 0}}, {"B", {0, 0}}, {"Z", {1, 2}}};
  }
  std::vector<std::string> input_files() const override { return files_; }
  std::vector<FirmwareImage> firmware() const override { return {{"toy.gia", "digest", {}}}; }
  std::vector<std::pair<std::string, double>> facts() const override { return {{"planes", 1}}; }

 private:
  bool crash_ = false;
  bool kill_ = false;  // ends the process that the worker works for
  std::vector<std::string> files_;
};

inline Catalogue catalogue() {
  MachineType type;
  type.name = "fake";
  type.presets = {"plain"};
  type.levels = {Level::kFunction, Level::kCycle};
  type.folder = "fake/machine";
  type.make = [](const config::ParameterSet& set, Level level, const MachineOptions&) {
    return std::make_unique<FakeMachine>(set, level);
  };
  MachineType other = type;
  other.name = "other";
  Algorithm toy{"toy",
                "a toy",
                {"fake"},
                "fake/algorithm",
                [](const scene::Scene& scene, const MachineType&, const config::ParameterSet&) {
                  return std::make_unique<FakeJob>(scene);
                },
                {"crash", "unbounded", "list", "kill"}};
  return {{type, other}, {toy}, "/nowhere"};
}

/// A folder of the test's own, removed at its end.
class TestFolder : public ::testing::Test {
 protected:
  TestFolder() {
    const auto* info = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::path(::testing::TempDir()) /
              (std::string("dendro_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  ~TestFolder() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return path(name);
  }
  std::string read(const std::string& name) const {
    std::ifstream in(folder_ / name);
    return std::string(std::istreambuf_iterator<char>(in), {});
  }
  /// The one line of the UserError that `action` throws, without the folder; "no error" if it throws none.
  template <class F>
  std::string error_of(F action) const {
    try {
      action();
    } catch (const UserError& e) {
      std::string what = e.what();
      const std::string prefix = folder_.string() + "/";
      for (std::size_t at; (at = what.find(prefix)) != std::string::npos;) what.erase(at, prefix.size());
      return what;
    }
    return "no error";
  }

  Catalogue catalogue_ = catalogue();
  std::filesystem::path folder_;
};

/// The smallest scene of the toy algorithm as a file's text.
inline std::string toy_scene(const std::string& more = "") {
  return "algorithm = \"toy\"\n[image]\nwidth = 2\nheight = 1\n[camera]\nheight = 1.0\n"
         "[[object]]\nplanes = [[1, 0, 0, 1]]\n" +
         more;
}

}  // namespace dendro::study::fake
