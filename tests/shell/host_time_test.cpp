#include "models/parts/ik11b/ik11b_isa.h"
#include "models/parts/ik11b/ik11b_shell.h"
#include "tests/shell/clocked_rig.h"

namespace dendro::ik11b {
namespace {

using rds3000::now_ps;

HostSpec spec() {
  HostSpec s;
  s.word_ps = 3'000;
  s.dma_start_ps = 1'000'000;
  s.register_ps = 700;
  s.program_load_ps = 50'000'000;
  s.interrupt_ps = 400'000;
  s.instruction_ps = 20;
  s.flop_ps = 90;
  return s;
}

/// A machine that answers at once, but for one access that takes `slow_ps`, and halts `run_ps` after it was started.
struct Machine : Target {
  std::uint32_t transfer(bool, std::uint32_t, std::uint32_t, unsigned) override {
    asked.push_back(now_ps());
    if (asked.size() == slow_access) sc_core::wait(sc_core::sc_time::from_value(slow_ps));
    return 0;
  }
  void command(bool run, bool) override {
    commanded = now_ps();
    if (run) event.notify(sc_core::sc_time::from_value(run_ps));
    up = run;
  }
  sc_core::sc_event& interrupt_event() override { return event; }
  bool interrupt() const override { return up && now_ps() >= commanded + static_cast<std::int64_t>(run_ps); }
  void clear_interrupt() override { up = false; }
  bool running() const override { return true; }
  std::exception_ptr error() const override { return nullptr; }
  std::uint32_t peek(std::uint32_t, unsigned) const override { return 0; }
  void program(std::string_view, std::uint32_t) override {}

  std::vector<std::int64_t> asked;
  std::int64_t commanded = 0;
  std::size_t slow_access = 0;
  sc_dt::uint64 slow_ps = 0, run_ps = 0;
  bool up = false;
  sc_core::sc_event event;
};

/// Runs the program; gives the time of its end.
std::int64_t end_of(Machine& machine, const std::function<void(HostPort&)>& program) {
  sc_core::sc_set_time_resolution(1, sc_core::SC_PS);
  Shell shell("host", spec(), machine, program);
  sc_core::sc_start();
  return shell.ended_ps();
}

TEST(HostTime, AWordByProgramTakesSixRegisterAccesses) {
  in_child([] {
    Machine machine;
    EXPECT_EQ(end_of(machine, [](HostPort& host) { host.write(0, 0, 0), host.read(0, 0), host.command(0); }), 13 * 700);
    EXPECT_EQ(machine.asked, (std::vector<std::int64_t>{6 * 700, 12 * 700}));
    EXPECT_EQ(machine.commanded, 13 * 700);
  });
}

TEST(HostTime, WordsOfATransferKeepTheInterfacesPace) {
  in_child([] {
    Machine machine;
    machine.slow_access = 2, machine.slow_ps = 7'500;
    const std::vector<std::uint32_t> words(5);
    end_of(machine, [&](HostPort& host) { host.dma_to(0, words.data(), words.size(), 0); });
    const std::int64_t start = 1'000'000;
    EXPECT_EQ(machine.asked, (std::vector<std::int64_t>{start, start + 3'000, start + 10'500, start + 10'500, start + 12'000}))
        << "a late word does not delay those that are not due yet";
  });
}

TEST(HostTime, EachStartedTransferPaysItsStart) {
  in_child([] {
    constexpr std::size_t kWords = kMaxTransferBytes / 4;
    Machine machine;
    std::vector<std::uint32_t> words(kWords + 1);
    end_of(machine, [&](HostPort& host) { host.dma_from(0, words.data(), words.size(), 0); });
    ASSERT_EQ(machine.asked.size(), kWords + 1);
    EXPECT_EQ(machine.asked[kWords - 1], 1'000'000 + static_cast<std::int64_t>(kWords - 1) * 3'000);
    EXPECT_EQ(machine.asked[kWords], machine.asked[kWords - 1] + 1'000'000);
  });
}

TEST(HostTime, TheProgramGoesOnTheInterruptTimeAfterTheHalt) {
  in_child([] {
    Machine machine;
    machine.run_ps = 5'000;
    const auto program = [](HostPort& host) { host.command(kRun), host.wait_interrupt(); };
    EXPECT_EQ(end_of(machine, program), 700 + 5'000 + 400'000);
    EXPECT_FALSE(machine.up);
  });
}

TEST(HostTime, ComputingTakesTheTimeOfItsWork) {
  in_child([] {
    Machine machine;
    EXPECT_EQ(end_of(machine, [](HostPort& host) { host.compute({3, 5, 2}); }), 3 * 90 + 5 * 20 + 2 * 50'000'000);
  });
}

}  // namespace
}  // namespace dendro::ik11b
