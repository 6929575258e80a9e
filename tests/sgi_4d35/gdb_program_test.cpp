#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <random>
#include <set>
#include <thread>

#include "models/machines/debuggee.h"
#include "models/machines/sgi_4d35/clocked.h"
#include "models/machines/sgi_4d35/cycle.h"
#include "models/machines/sgi_4d35/function.h"
#include "sim/base/error.h"
#include "sim/study/gdb_socket.h"
#include "tests/sgi_4d35/random_program.h"
#include "tests/sgi_4d35/timing_rig.h"

namespace dendro::sgi_4d35 {
namespace {

struct Calls : service_block::Services {
  service_block::CallResult call(std::uint32_t number, const std::array<std::uint32_t, 4>&,
                                 base::ZeroedBytes&) override {
    return {0, false, number < DENDRO_MARK_START || number > DENDRO_MARK_LABEL};
  }
};

/// Steps, runs to places it has been at, interrupts, looks at registers and memory; lets go after some stops.
class Nosy : public Debugger {
 public:
  Nosy(std::uint32_t seed, unsigned most) : random_(seed), left_(most) {}
  bool debug(Debuggee& program) override {
    std::uint32_t broken = 0;
    for (Debuggee::Stop stop; left_ != 0 && !stop.ended; --left_, ++stops) {
      const std::uint32_t pc = program.registers()[program.program_counter()];
      std::uint8_t bytes[64];
      program.read(pc, bytes, sizeof bytes);
      program.read(static_cast<std::uint32_t>(random_()), bytes, sizeof bytes);
      if (random_() % 16 == 0) {
        program.set_breakpoint(broken, false);
        program.set_breakpoint(broken = pc, true);
      }
      stop = random_() % 256 == 0 ? program.run([this] { return random_() % 2 == 0; }) : program.step();
    }
    return true;
  }
  unsigned stops = 0;

 private:
  std::mt19937 random_;
  unsigned left_;
};

std::map<std::string, std::uint64_t> counters_of(const ProgramResult& result) {
  std::map<std::string, std::uint64_t> counters;
  for (const UnitStats& unit : result.units)
    for (const auto& [name, value] : unit.values) counters[unit.unit + "." + name] = value;
  return counters;
}

class GdbTimed : public testing::TestWithParam<Level> {};
INSTANTIATE_TEST_SUITE_P(Levels, GdbTimed, testing::Values(Level::kCycle, Level::kClocked),
                         [](const auto& instance) { return std::string(level_name(instance.param)); });

TEST_P(GdbTimed, StopsAndLooksChangeNoClockNoCounterAndNoRegister) {
  unsigned stops = 0;
  for (std::uint32_t seed = 1; seed <= 40; ++seed) {
    const Spec spec = random_spec(seed);
    ProgramImage image = image_of(random_program(seed, 200, 3), kCode + 0x800);
    image.program.entry = image.start;
    const auto run = [&](Debugger* debugger, r3000::State& state) {
      Calls calls;
      RunOptions options;
      options.final_state = &state;
      options.machine.debugger = debugger;
      return (GetParam() == Level::kCycle ? run_cycle : run_clocked)(spec, image, calls, 20000, options);
    };
    r3000::State plain, stopped;
    const ProgramResult expected = run(nullptr, plain);
    Nosy nosy(seed, seed % 3 == 0 ? 500 : UINT32_MAX);
    const ProgramResult result = run(&nosy, stopped);
    stops += nosy.stops;
    EXPECT_EQ(expected.cycles, result.cycles) << "seed " << seed;
    EXPECT_EQ(counters_of(expected), counters_of(result)) << "seed " << seed;
    EXPECT_EQ(expected.stopped, result.stopped) << "seed " << seed;
    EXPECT_EQ(plain.pc, stopped.pc) << "seed " << seed;
    EXPECT_TRUE(std::equal(plain.r, plain.r + 32, stopped.r)) << "seed " << seed;
    EXPECT_TRUE(std::equal(plain.fpu.r, plain.fpu.r + 32, stopped.fpu.r)) << "seed " << seed;
    EXPECT_EQ(plain.cause, stopped.cause) << "seed " << seed;
  }
  EXPECT_GT(stops, 10000u);
}

/// What GDB would see before every word.
class Reader : public Debugger {
 public:
  bool debug(Debuggee& program) override {
    for (Debuggee::Stop stop; !stop.ended; stop = program.step()) seen.push_back(program.registers());
    return true;
  }
  std::vector<std::vector<std::uint32_t>> seen;
};

TEST(GdbProgram, RegistersBeforeEveryWordAreTheSameAtEveryLevel) {
  std::size_t words = 0;
  for (std::uint32_t seed = 1; seed <= 30; ++seed) {
    const Spec spec = random_spec(seed);
    ProgramImage image = image_of(random_program(seed, 200, 3), kCode + 0x800);
    image.program.entry = image.start;
    Calls calls;
    Reader function, cycle, clocked;
    MachineOptions options;
    options.debugger = &function;
    run_function(spec, image, calls, 3000, options);
    RunOptions timed;
    timed.machine.debugger = &cycle;
    run_cycle(spec, image, calls, 3000, timed);
    timed.machine.debugger = &clocked;
    run_clocked(spec, image, calls, 3000, timed);
    ASSERT_EQ(function.seen.size(), clocked.seen.size()) << "seed " << seed;
    ASSERT_EQ(function.seen.size(), cycle.seen.size()) << "seed " << seed;
    for (std::size_t word = 0; word < function.seen.size(); ++word) {
      ASSERT_EQ(function.seen[word], cycle.seen[word]) << "seed " << seed << " word " << word;
      ASSERT_EQ(function.seen[word], clocked.seen[word]) << "seed " << seed << " word " << word;
    }
    words += function.seen.size();
  }
  EXPECT_GT(words, 10000u);
}

/// GDB's side of a connection.
class Client {
 public:
  explicit Client(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    EXPECT_EQ(0, connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address)) << std::strerror(errno);
  }
  ~Client() { close(socket_); }
  void send(const std::string& bytes) {
    EXPECT_EQ(static_cast<ssize_t>(bytes.size()), ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }
  std::string answer() {
    std::string text;
    for (char c = 0; recv(socket_, &c, 1, 0) == 1;) {
      text += c;
      if (text.size() > 3 && text[text.size() - 3] == '#') break;
    }
    const auto begin = text.find('$');
    return begin == std::string::npos ? text : text.substr(begin + 1, text.size() - begin - 4);
  }
  std::string ask(const std::string& text) {
    send(study::GdbSession::packet(text));
    return answer();
  }

 private:
  int socket_;
};

/// Counts t0 down from 5 and stops; kCode + 4 is the loop.
ProgramImage countdown(int from) {
  ProgramImage image = image_of({{kCode,
                                  {or_immediate(kT0, 0, from), add_immediate(kT0, kT0, -1),
                                   r3000::i_word(r3000::kMajorBne, 0, kT0, -2), kNop, high(kT1, 0xBF00),
                                   store(0, kT1), kNop, kNop}}},
                                kCode);
  image.program.entry = image.start;
  return image;
}

ProgramResult run_at(Level level, const ProgramImage& image, Debugger* debugger, std::uint64_t limit) {
  Calls calls;
  RunOptions options;
  options.machine.debugger = debugger;
  return level == Level::kClocked ? run_clocked(small(), image, calls, limit, options)
         : level == Level::kCycle ? run_cycle(small(), image, calls, limit, options)
                                  : run_function(small(), image, calls, limit, options.machine);
}

TEST(GdbProgram, ASocketDrivesItFromTheFirstWordToTheEnd) {
  for (const Level level : {Level::kFunction, Level::kCycle}) {
    study::GdbSocket gdb(0, [] { return std::optional<int>(3); });
    ASSERT_GT(gdb.port(), 0);
    std::thread client([port = gdb.port()] {
      Client c(port);
      EXPECT_EQ("S05", c.ask("?"));
      EXPECT_EQ("80010000", c.ask("p25"));
      EXPECT_EQ(72u * 8, c.ask("g").size());
      EXPECT_EQ("34080005", c.ask("m80010000,4"));
      EXPECT_EQ("34080005", c.ask("ma0010000,4"));
      EXPECT_EQ("E02", c.ask("m9f000000,4"));
      EXPECT_EQ("OK", c.ask("Z0,80010004,4"));
      EXPECT_EQ("S05", c.ask("c"));
      EXPECT_EQ("00000005", c.ask("p8"));
      EXPECT_EQ("S05", c.ask("s"));
      EXPECT_EQ("00000004", c.ask("p8"));
      EXPECT_EQ("80010008", c.ask("p25"));
      EXPECT_EQ("S05", c.ask("c"));
      EXPECT_EQ("80010004", c.ask("p25"));
      EXPECT_EQ("OK", c.ask("P8=1"));
      EXPECT_EQ("OK", c.ask("z0,80010004,4"));
      EXPECT_EQ("OK", c.ask("Z0,80010010,4"));
      EXPECT_EQ("S05", c.ask("c"));
      EXPECT_EQ("00000000", c.ask("p8"));
      EXPECT_EQ("OK", c.ask("P25=80010000"));
      EXPECT_EQ("OK", c.ask("M80010000,4:34080002"));
      EXPECT_EQ("S05", c.ask("s"));
      EXPECT_EQ("00000002", c.ask("p8"));
      EXPECT_EQ("S05", c.ask("c"));
      EXPECT_EQ("W03", c.ask("c"));
    });
    const ProgramResult result = run_at(level, countdown(5), &gdb, 1000);
    client.join();
    EXPECT_TRUE(result.stopped);
    EXPECT_FALSE(gdb.killed());
    // One word, one turn and another whose count was made 1; again one word and two turns; the stop's two words.
    EXPECT_EQ(7u + 7u + 2u, result.instructions);
  }
}

TEST(GdbProgram, ControlCStopsAnEndlessProgramAndKillEndsIt) {
  study::GdbSocket gdb(0, [] { return std::optional<int>(); });
  std::thread client([port = gdb.port()] {
    Client c(port);
    c.send(study::GdbSession::packet("c"));
    c.send("\3");
    EXPECT_EQ("S02", c.answer());
    c.send(study::GdbSession::packet("k"));
  });
  ProgramImage image = image_of({{kCode, {branch_always(-1), kNop}}}, kCode);
  image.program.entry = image.start;
  const ProgramResult result = run_at(Level::kFunction, image, &gdb, UINT64_MAX);
  client.join();
  EXPECT_FALSE(result.stopped);
  EXPECT_TRUE(gdb.killed());
}

TEST(GdbProgram, AfterADetachItRunsAsIfNobodyHadLooked) {
  study::GdbSocket gdb(0, [] { return std::optional<int>(); });
  std::thread client([port = gdb.port()] {
    Client c(port);
    EXPECT_EQ("OK", c.ask("Z0,80010004,4"));
    EXPECT_EQ("S05", c.ask("c"));
    EXPECT_EQ("OK", c.ask("D"));
  });
  const ProgramResult result = run_at(Level::kCycle, countdown(100), &gdb, 100000);
  client.join();
  const ProgramResult plain = run_at(Level::kCycle, countdown(100), nullptr, 100000);
  EXPECT_TRUE(result.stopped);
  EXPECT_EQ(plain.cycles, result.cycles);
  EXPECT_EQ(plain.instructions, result.instructions);
}

TEST(GdbProgram, AtClockedOneLooksAndStepsButWritesNothing) {
  study::GdbSocket gdb(0, [] { return std::optional<int>(3); });
  std::thread client([port = gdb.port()] {
    Client c(port);
    EXPECT_EQ("OK", c.ask("Z0,80010004,4"));
    EXPECT_EQ("S05", c.ask("c"));
    EXPECT_EQ("00000005", c.ask("p8"));
    EXPECT_EQ('E', c.ask("P8=1").at(0));
    EXPECT_EQ('E', c.ask("M80010000,4:34080002").at(0));
    EXPECT_EQ("S05", c.ask("s"));
    EXPECT_EQ("00000004", c.ask("p8"));
    EXPECT_EQ("80010008", c.ask("p25"));
    EXPECT_EQ("OK", c.ask("z0,80010004,4"));
    EXPECT_EQ("W03", c.ask("c"));
  });
  const ProgramResult result = run_at(Level::kClocked, countdown(5), &gdb, 1000);
  client.join();
  EXPECT_EQ(run_at(Level::kCycle, countdown(5), nullptr, 1000).cycles, result.cycles);
}

TEST(GdbProgram, APortInUseIsTheUsersError) {
  study::GdbSocket gdb(0, [] { return std::optional<int>(); });
  EXPECT_THROW(study::GdbSocket(gdb.port(), [] { return std::optional<int>(); }), UserError);
}

}  // namespace
}  // namespace dendro::sgi_4d35
