#include "sim/study/sweep.h"

#include <sys/wait.h>

#include <cmath>

#include "sim/study/sweep_report.h"
#include "sim/study/worker.h"
#include "tests/core/study/fake_machine.h"

namespace dendro::study {
namespace {

const char* const kHead = "scene = \"toy.toml\"\noutputs = [\"cycles\", \"phase.scan.cycles\"]\n";
const char* const kAxisB = "[[axis]]\nkey = \"parameters.delay.b_ticks\"\nvalues = [4, 5, 6]\n";
const char* const kAxisKind = "[[axis]]\nkey = \"parameters.mode.kind\"\nvalues = [\"plain\", \"dense\"]\n";

class SweepTest : public fake::TestFolder {
 protected:
  SweepTest() { write("toy.toml", fake::toy_scene()); }

  Study study(const std::string& text) const { return load_study(write("s.toml", text), false); }
  SweepOutcome run(const std::string& text, int jobs = 2) const {
    return sweep(catalogue_, study(text), {path("out"), jobs}, nullptr);
  }
};

TEST_F(SweepTest, EveryPointIsTheRunOfItsSettings) {
  const SweepOutcome outcome = run(std::string(kHead) + kAxisB + kAxisKind);
  ASSERT_EQ(6u, outcome.rows.size());
  EXPECT_EQ(6u, outcome.made);
  for (std::size_t i = 0; i < 6; ++i) {
    const double b = 4 + static_cast<double>(i / 2), delays = 10 + b + b;  // c follows b
    EXPECT_EQ(i % 2 == 0 ? 2 * delays : delays, output_of(outcome.rows[i], "phase.scan.cycles")) << i;
  }
}

TEST_F(SweepTest, FinishedRunsAreNotRepeated) {
  run(std::string(kHead) + kAxisB);
  const SweepOutcome again = run(std::string(kHead) + kAxisB);
  EXPECT_EQ(0u, again.made);
  EXPECT_EQ(3u, again.found);
  EXPECT_EQ(36, output_of(again.rows[0], "phase.scan.cycles"));
  const SweepOutcome more =
      run(std::string(kHead) + "[[axis]]\nkey = \"parameters.delay.b_ticks\"\nvalues = [6, 7, 4]\n");
  EXPECT_EQ(1u, more.made) << "another study finds the same runs";
  EXPECT_EQ(2 * (10 + 6 + 6), output_of(more.rows[0], "phase.scan.cycles"));
}

TEST_F(SweepTest, RunsSurviveAKill) {
  const std::string axis = "[[axis]]\nkey = \"toy.kill\"\nvalues = ";
  const pid_t pid = ::fork();
  if (pid == 0) {
    try {
      run(kHead + axis + "[false, true]\n", 1);
    } catch (...) {
    }
    std::_Exit(0);
  }
  int status = 0;
  ASSERT_EQ(pid, ::waitpid(pid, &status, 0));
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(SIGKILL, WTERMSIG(status));
  const SweepOutcome rest = run(kHead + axis + "[false]\n");
  EXPECT_EQ(1u, rest.found);
  EXPECT_EQ(0u, rest.made);
}

TEST_F(SweepTest, RunsSurviveACrashOfAnother) {
  const std::string axis = "[[axis]]\nkey = \"toy.crash\"\nvalues = ";
  EXPECT_THROW(run(kHead + axis + "[false, true]\n", 1), WorkerCrash);
  EXPECT_EQ(1u, run(kHead + axis + "[false]\n").found);
}

TEST_F(SweepTest, AChangedInputFileIsAnotherRun) {
  write("m.obj", "v 0 0 0\n");
  write("scene.toml",
        "algorithm = \"toy\"\n[image]\nheight = 1\n[camera]\nheight = 1.0\n[[object]]\nmesh = \"m.obj\"\n");
  const std::string text = std::string("scene = \"scene.toml\"\n") + kAxisB;
  EXPECT_EQ(3u, run(text).made);
  EXPECT_EQ(0u, run(text).made);
  write("m.obj", "v 0 0 1\n");
  EXPECT_EQ(3u, run(text).made);
}

TEST_F(SweepTest, WhatTheMachineRefusesIsARowThatSaysWhy) {
  const std::string text =
      std::string(kHead) + "[[axis]]\nkey = \"parameters.delay.b_ticks\"\nvalues = [5, 8]\n" + kAxisKind;
  for (const std::size_t made : {4u, 0u}) {
    const SweepOutcome outcome = run(text);
    EXPECT_EQ(made, outcome.made) << "a refused run is not tried again either";
    EXPECT_EQ(1u, outcome.refused);
    EXPECT_EQ("delay.c_ticks: too slow for dense words", outcome.rows[3].refused);
    EXPECT_TRUE(std::isnan(output_of(outcome.rows[3], "cycles")));
  }
}

TEST_F(SweepTest, WhenEveryRunIsRefusedTheStudyIsWrong) {
  const std::string text = std::string(kHead) +
                           "[[axis]]\nkey = \"parameters.delay.b_ticks\"\nvalues = [7, 8]\n"
                           "[[axis]]\nkey = \"parameters.mode.kind\"\nvalues = [\"dense\"]\n";
  EXPECT_EQ("s.toml: every run is refused: delay.c_ticks: too slow for dense words", error_of([&] { run(text); }));
}

TEST_F(SweepTest, WrongKeysTypesAndLevelsCostNoRun) {
  const auto error = [&](const std::string& text) { return error_of([&] { run(text); }); };
  const std::string axis = "[[axis]]\nkey = \"parameters.delay.";
  EXPECT_EQ("s.toml:3: parameters.delay.d_ticks: the machine has no such parameter; did you mean `delay.a_ticks`?",
            error(kHead + axis + "d_ticks\"\nvalues = [1]\n"));
  EXPECT_EQ(0u, error(kHead + axis + "a_ticks\"\nvalues = [1, \"x\"]\n").find("s.toml:3: parameters.delay.a_ticks: "));
  EXPECT_EQ(0u, error(std::string(kHead) + "[[axis]]\nkey = \"image.widht\"\nvalues = [1]\n").find("s.toml:3: image."));
  EXPECT_EQ(0u, error(std::string(kHead) + "levels = [\"clocked\"]\n" + kAxisB).find("s.toml:3: levels: "));
  EXPECT_EQ(0u, error(std::string(kHead) + "machine = \"faek\"\n" + kAxisB).find("s.toml:3: machine: "));
  EXPECT_EQ(0u, error(std::string("scene = \"toi\"\n") + kAxisB).find("s.toml:1: scene: toi: there is no such scene"));
  EXPECT_EQ(0u, error(std::string(kHead) + "[set]\n\"image.widht\" = 1\n" + kAxisB).find("s.toml:3: "));
  EXPECT_FALSE(std::filesystem::exists(path("out"))) << "nothing was made";
}

TEST_F(SweepTest, AnOutputThatRunsDoNotHaveNamesTheNearest) {
  const std::string text = std::string("scene = \"toy.toml\"\noutputs = [\"cycels\"]\n") + kAxisB;
  EXPECT_EQ("s.toml:2: outputs: runs have no figure `cycels`; did you mean `cycles`?", error_of([&] { run(text); }));
  EXPECT_LE(1u, run(std::string(kHead) + kAxisB).found) << "the run that was made is kept";
}

TEST_F(SweepTest, LevelsStandBesideEachOther) {
  const SweepOutcome outcome = run(std::string(kHead) + "levels = [\"function\", \"cycle\"]\n" + kAxisB);
  ASSERT_EQ(6u, outcome.rows.size());
  EXPECT_EQ(0, output_of(outcome.rows[0], "cycles"));
  EXPECT_EQ(100 + 36, output_of(outcome.rows[3], "cycles"));
}

TEST_F(SweepTest, MachinesStandBesideEachOther) {
  write("slow.toml", "include = [\"fake:plain\"]\n[delay]\na_ticks = { value = 20, source = \"by decree\" }\n");
  const std::string machines = "[[axis]]\nkey = \"machine\"\nvalues = [\"fake:plain\", \"slow.toml\"]\n";
  const std::string text = kHead + machines + kAxisB;
  const SweepOutcome outcome = run(text);
  ASSERT_EQ(6u, outcome.rows.size());
  EXPECT_EQ(2 * (10 + 5 + 5), output_of(outcome.rows[1], "phase.scan.cycles"));
  EXPECT_EQ(2 * (20 + 5 + 5), output_of(outcome.rows[4], "phase.scan.cycles"));
  EXPECT_NE(std::string::npos, sweep_csv(study(text), outcome.rows).find("slow.toml,5,"));
  const auto error = [&](const std::string& wrong) { return error_of([&] { run(wrong); }); };
  EXPECT_EQ(0u, error(std::string(kHead) + "[[axis]]\nkey = \"machine\"\nvalues = [\"faek\"]\n").find("s.toml:3: machine: "));
  EXPECT_EQ(0u, error(std::string(kHead) + "[[axis]]\nkey = \"machine\"\nvalues = [1]\n").find("s.toml:3: machine: "));
  EXPECT_EQ("s.toml:3: machine: an axis varies the machine", error(std::string(kHead) + "machine = \"fake\"\n" + machines));
}

TEST_F(SweepTest, AnOutputMayBeAQuotient) {
  const std::string text = "scene = \"toy.toml\"\noutputs = [\"cycles per phase.scan.cycles\"]\n";
  const SweepOutcome outcome = run(text + kAxisB);
  EXPECT_EQ(136.0 / 36.0, output_of(outcome.rows[0], "cycles per phase.scan.cycles"));
  EXPECT_EQ("s.toml:2: outputs: runs have no figure `cycels`; did you mean `cycles`?",
            error_of([&] { run("scene = \"toy.toml\"\noutputs = [\"phase.scan.cycles per cycels\"]\n" + std::string(kAxisB)); }));
}

TEST_F(SweepTest, LabelsAndALogarithmChangeThePictureAlone) {
  const std::string plain = std::string(kHead) + kAxisB, wrong = std::string(kHead) + "output_labels = [\"a\"]\n" + kAxisB;
  const SweepOutcome outcome = run(plain);
  const auto picture = [&](const std::string& head) {
    return sweep_picture(study(head + kAxisB), outcome.rows, "cycles").rgb;
  };
  EXPECT_NE(picture(kHead), picture(std::string(kHead) + "output_labels = [\"ticks\", \"ticks of the scan\"]\n"));
  EXPECT_NE(picture(kHead), picture(std::string(kHead) + "output_scale = \"log\"\n"));
  EXPECT_EQ("s.toml:3: output_labels: 1 labels for 2 outputs", error_of([&] { study(wrong); }));
}

TEST_F(SweepTest, TheTableHasEveryParameterOfEveryRun) {
  const std::string text = std::string(kHead) + "seed = 77\n" + kAxisB;
  const SweepOutcome outcome = run(text);
  const std::string csv = sweep_csv(study(text), outcome.rows);
  EXPECT_EQ(4, std::count(csv.begin(), csv.end(), '\n'));
  EXPECT_EQ(0u, csv.find("point,level,parameters.delay.b_ticks,cycles,phase.scan.cycles,refused,scene,machine,preset,"
                         "seed,git,image_sha256,resolved.clock.hz,resolved.delay.a_ticks,resolved.delay.b_ticks,"
                         "resolved.delay.c_ticks"));
  EXPECT_NE(std::string::npos, csv.find("\n1,cycle,5,140,40,,toy,fake,plain,77,"));
  EXPECT_NE(std::string::npos, csv.find(",1000.0,10,5,5,100.0,"));
}

TEST_F(SweepTest, OneAxisIsACurveTwoAreAMapThreeAreNoPicture) {
  const std::string a = "[[axis]]\nkey = \"parameters.delay.a_ticks\"\nvalues = [5, 6]\n";
  EXPECT_TRUE(has_picture(study(std::string(kHead) + kAxisB)));
  EXPECT_FALSE(has_picture(study(std::string(kHead) + kAxisB + kAxisKind + a)));
  const std::string text = std::string(kHead) + kAxisB + kAxisKind;
  ASSERT_TRUE(has_picture(study(text)));
  const SweepOutcome outcome = run(text);
  const auto cycles = sweep_picture(study(text), outcome.rows, "cycles");
  EXPECT_NE(cycles.rgb, sweep_picture(study(text), outcome.rows, "phase.scan.cycles").rgb);
}

TEST_F(SweepTest, TwoSweepsDoNotShareAFolder) {
  std::filesystem::create_directory(path("out"));
  SweepResults first(path("out/results.sqlite"));
  EXPECT_NE(std::string::npos, error_of([&] { run(std::string(kHead) + kAxisB); }).find("locked"));
}

}  // namespace
}  // namespace dendro::study
