#include "sim/study/run.h"

#include "sim/study/cache.h"
#include "sim/study/worker.h"
#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

class RunTest : public fake::TestFolder {
 protected:
  RunRequest request(const std::string& text, RunArguments arguments = {}) {
    arguments.scene = write("s.toml", text);
    return prepare_run(catalogue_, arguments);
  }
};

TEST_F(RunTest, ParametersOfTheSceneStandAboveThePreset) {
  const RunRequest r = request(fake::toy_scene("[parameters.delay]\nb_ticks = 6\n"));
  EXPECT_EQ(config::Value(std::int64_t{6}), r.preset.parameters.find("delay.b_ticks")->value);
  EXPECT_EQ(config::Value(std::int64_t{6}), r.preset.parameters.find("delay.c_ticks")->value) << "it follows";
  EXPECT_EQ(100 + 2 * (10 + 6 + 6), execute(r, "", nullptr).object.cycles);
}

TEST_F(RunTest, AnUnknownParameterNamesTheNearest) {
  EXPECT_EQ("s.toml:10: delay.d_ticks: the machine has no such parameter; did you mean `delay.a_ticks`?",
            error_of([&] { request(fake::toy_scene("[parameters.delay]\nd_ticks = 6\n")); }));
}

TEST_F(RunTest, AMachineWithoutFirmwareIsAUserError) {
  RunArguments arguments;
  arguments.machine = "other";
  EXPECT_EQ("--machine: machine: other has no firmware for toy; it runs on fake",
            error_of([&] { request(fake::toy_scene(), arguments); }));
}

TEST_F(RunTest, AMissingLevelIsAUserError) {
  RunArguments arguments;
  arguments.level = "clocked";
  EXPECT_EQ("--level: fake has no level `clocked`: known are function, cycle",
            error_of([&] { request(fake::toy_scene(), arguments); }));
}

TEST_F(RunTest, TheResolvedSceneRepeatsTheRun) {
  RunArguments arguments;
  arguments.settings = {"parameters.delay.b_ticks=7", "image.width=2"};
  arguments.seed = 99;
  const std::string mesh = write("m.obj", "v 0 0 0\n");
  const std::string text =
      "algorithm = \"toy\"\ndescription = \"x @ y\"\n[image]\nheight = 1\n[camera]\nheight = "
      "1.0\n[[object]]\nmesh = \"m.obj\"\n";
  const RunRequest first = request(text, arguments);
  const RunOutput output = execute(first, "", nullptr);
  std::filesystem::create_directory(path("run"));
  write("run/resolved.toml", resolved_scene(first, output, path("run")));

  RunArguments again;
  again.scene = path("run/resolved.toml");
  const RunRequest second = prepare_run(catalogue_, again);
  const RunOutput repeated = execute(second, "", nullptr);
  EXPECT_EQ(output.object.cycles, repeated.object.cycles);
  EXPECT_EQ(99u, repeated.object.seed);
  EXPECT_EQ(output.object.scene, repeated.object.scene);
  EXPECT_EQ(output.object.assumptions, repeated.object.assumptions);
  EXPECT_EQ(resolved_scene(first, output, path("run")), resolved_scene(second, repeated, path("run")));

  std::ofstream(mesh) << "v 0 0 1\n";
  EXPECT_NE(std::string::npos, error_of([&] { prepare_run(catalogue_, again); }).find("m.obj has changed"));
  again.machine = "fake";
  EXPECT_NE(std::string::npos, error_of([&] { prepare_run(catalogue_, again); }).find("use --set"));
}

TEST_F(RunTest, AResolvedSceneInsistsOnItsFirmware) {
  RunRequest r = request(fake::toy_scene("[[firmware]]\nname = \"toy.gia\"\nsha256 = \"another\"\n"));
  EXPECT_EQ(
      0u, error_of([&] { execute(r, "", nullptr); }).find("s.toml:9: firmware: toy.gia is not the firmware"));
}

TEST_F(RunTest, OutputsSurviveThePipe) {
  const RunOutput output = execute(request(fake::toy_scene()), "", nullptr);
  EXPECT_EQ(to_bytes(output), to_bytes(from_bytes(to_bytes(output))));
  EXPECT_EQ(6u, from_bytes(to_bytes(output)).rgb.size());
}

TEST_F(RunTest, ACrashInAWorkerIsABugAndNotAnErrorOfTheUser) {
  EXPECT_THROW(execute_in_worker(request(fake::toy_scene("[toy]\ncrash = true\n")), "", nullptr),
               WorkerCrash);
}

TEST_F(RunTest, TheCacheKeyDependsOnEverythingThatTheRunDependsOn) {
  const std::string mesh = write("m.obj", "v 0 0 0\n");
  const std::string text =
      "algorithm = \"toy\"\n[image]\nheight = 1\n[camera]\nheight = 1.0\n[[object]]\nmesh = \"m.obj\"\n";
  const std::string key = RunCache::key(request(text));
  EXPECT_EQ(key, RunCache::key(request(text)));
  RunArguments other;
  other.seed = 5;
  EXPECT_NE(key, RunCache::key(request(text, other)));
  RunArguments level;
  level.level = "function";
  EXPECT_NE(key, RunCache::key(request(text, level)));
  RunArguments setting;
  setting.settings = {"parameters.delay.a_ticks=11"};
  EXPECT_NE(key, RunCache::key(request(text, setting)));
  std::ofstream(mesh) << "v 0 0 1\n";
  EXPECT_NE(key, RunCache::key(request(text)));
}

}  // namespace
}  // namespace dendro::study
