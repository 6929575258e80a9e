#include <gtest/gtest.h>

#include <map>
#include <set>

#include "sim/study/gdb_server.h"

namespace dendro::study {
namespace {

/// Four registers, the last of them the program counter and the second one fixed; 16 bytes at 0x1000; ends at 0x40.
class Small : public Debuggee {
 public:
  const std::string& description() const override { return text; }
  std::vector<std::uint32_t> registers() const override { return values; }
  std::size_t program_counter() const override { return 3; }
  bool set_register(std::size_t number, std::uint32_t value) override {
    if (number >= 4 || number == 1) return false;
    values[number] = value;
    return true;
  }
  std::size_t read(std::uint32_t address, std::uint8_t* to, std::size_t bytes) const override {
    std::size_t i = 0;
    for (; i < bytes && address + i - 0x1000 < 16; ++i) to[i] = memory[address + i - 0x1000];
    return i;
  }
  std::size_t write(std::uint32_t address, const std::uint8_t* from, std::size_t bytes) override {
    std::size_t i = 0;
    for (; i < bytes && address + i - 0x1000 < 16; ++i) memory[address + i - 0x1000] = from[i];
    return i;
  }
  void set_breakpoint(std::uint32_t address, bool on) override {
    if (on)
      breakpoints.insert(address);
    else
      breakpoints.erase(address);
  }
  Stop step() override {
    values[3] += 4;
    return values[3] < 0x40 ? Stop{kTrap, false} : Stop{0, true};
  }
  Stop run(const std::function<bool()>& interrupted) override {
    Stop stop;
    do {
      stop = step();
      if (interrupted()) return {kInterrupted, false};
    } while (!stop.ended && breakpoints.count(values[3]) == 0);
    return stop;
  }

  std::string text = std::string(100, 'x');
  std::vector<std::uint32_t> values = {1, 0x80000002, 3, 0x10};
  std::uint8_t memory[16] = {0xDE, 0xAD, 0xBE, 0xEF};
  std::set<std::uint32_t> breakpoints;
};

class GdbProtocol : public testing::Test {
 protected:
  /// The answer to a packet, without its frame.
  std::string ask(const std::string& text) {
    const std::string sent = session_.receive(GdbSession::packet(text));
    if (sent.size() < 5) return sent;
    EXPECT_EQ("+" + GdbSession::packet(sent.substr(2, sent.size() - 5)), sent);
    return sent.substr(2, sent.size() - 5);
  }

  Small program_;
  bool interrupt_ = false;
  std::optional<int> exit_code_ = 7;
  GdbSession session_{program_, [this] { return interrupt_; }, [this] { return exit_code_; }};
};

TEST_F(GdbProtocol, PacketsHaveTheChecksumOfTheProtocol) {
  EXPECT_EQ("$OK#9a", GdbSession::packet("OK"));
  EXPECT_EQ("$#00", GdbSession::packet(""));
}

TEST_F(GdbProtocol, PiecesOfAnySizeMakeAPacket) {
  EXPECT_EQ("", session_.receive("+$"));
  EXPECT_EQ("", session_.receive("?#3"));
  EXPECT_EQ("+$S05#b8", session_.receive("f"));
  EXPECT_EQ("+$S05#b8+$S05#b8", session_.receive("$?#3f$?#3f"));
}

TEST_F(GdbProtocol, AWrongChecksumIsAskedForAgainAndDoesNothing) {
  EXPECT_EQ("-", session_.receive("$s#00"));
  EXPECT_EQ(0x10u, program_.values[3]);
  EXPECT_EQ("OK", ask("QStartNoAckMode"));
  EXPECT_EQ("$S05#b8", session_.receive("$?#3f"));
}

TEST_F(GdbProtocol, RegistersAreReadAndWritten) {
  EXPECT_EQ("00000001800000020000000300000010", ask("g"));
  EXPECT_EQ("80000002", ask("p1"));
  EXPECT_EQ("E01", ask("p4"));
  EXPECT_EQ("OK", ask("P2=cafe0001"));
  EXPECT_EQ(0xCAFE0001u, program_.values[2]);
  EXPECT_EQ("OK", ask("P2=ffffffff80001000"));
  EXPECT_EQ(0x80001000u, program_.values[2]);
  EXPECT_EQ("E03", ask("P1=5"));
  EXPECT_EQ("OK", ask("G00000009800000020000000300000014"));
  EXPECT_EQ((std::vector<std::uint32_t>{9, 0x80000002, 3, 0x14}), program_.values);
  EXPECT_EQ("E03", ask("G00000009000000000000000300000014"));
  EXPECT_EQ("E01", ask("G00"));
}

TEST_F(GdbProtocol, MemoryIsReadUpToItsEndAndWrittenWhole) {
  EXPECT_EQ("deadbeef", ask("m1000,4"));
  EXPECT_EQ("0000", ask("m100e,8"));
  EXPECT_EQ("E02", ask("m2000,4"));
  EXPECT_EQ("OK", ask("M1001,2:0102"));
  EXPECT_EQ("de0102ef", ask("m1000,4"));
  EXPECT_EQ("E02", ask("M100f,2:0102"));
  for (const char* bad : {"m", "m1000", "mx,4", "M1000,2:01", "M1000,1:0g", "M1000,1"}) EXPECT_EQ("E01", ask(bad)) << bad;
}

TEST_F(GdbProtocol, BreakpointsStopBeforeTheirWordAndTheEndIsTold) {
  EXPECT_EQ("OK", ask("Z0,20,4"));
  EXPECT_EQ("OK", ask("Z1,28,4"));
  EXPECT_EQ("", ask("Z2,28,4"));
  EXPECT_EQ("S05", ask("c"));
  EXPECT_EQ(0x20u, program_.values[3]);
  EXPECT_EQ("S05", ask("vCont;s:1;c"));
  EXPECT_EQ(0x24u, program_.values[3]);
  EXPECT_EQ("OK", ask("z1,28,4"));
  EXPECT_EQ("S05", ask("s30"));
  EXPECT_EQ(0x34u, program_.values[3]);
  EXPECT_FALSE(session_.ending());
  EXPECT_EQ("W07", ask("vCont;c"));
  EXPECT_EQ(GdbSession::Ending::kEnded, session_.ending());
}

TEST_F(GdbProtocol, AnInterruptIsSignalTwo) {
  interrupt_ = true;
  EXPECT_EQ("S02", ask("c"));
  EXPECT_EQ("S02", ask("?"));
}

TEST_F(GdbProtocol, DetachIsAnsweredAndKillIsNot) {
  EXPECT_EQ("OK", ask("D"));
  EXPECT_EQ(GdbSession::Ending::kDetached, session_.ending());
  GdbSession other(program_, [] { return false; }, [] { return std::optional<int>(); });
  EXPECT_EQ("+", other.receive("$k#6b"));
  EXPECT_EQ(GdbSession::Ending::kKilled, other.ending());
}

TEST_F(GdbProtocol, TheDescriptionComesInPieces) {
  EXPECT_NE(std::string::npos, ask("qSupported:multiprocess+").find("qXfer:features:read+"));
  EXPECT_EQ("m" + std::string(60, 'x'), ask("qXfer:features:read:target.xml:0,3c"));
  EXPECT_EQ("l" + std::string(40, 'x'), ask("qXfer:features:read:target.xml:3c,3c"));
  EXPECT_EQ("l", ask("qXfer:features:read:target.xml:64,3c"));
}

TEST_F(GdbProtocol, WhatIsNotKnownGetsTheEmptyAnswer) {
  for (const char* text : {"", "X1000,0:", "vMustReplyEmpty", "qTStatus", "!"}) EXPECT_EQ("", ask(text)) << text;
}

}  // namespace
}  // namespace dendro::study
