#include <filesystem>
#include <fstream>
#include <sstream>

#include "sim/base/error.h"
#include "tests/shell/clocked_rig.h"

namespace dendro::rds3000 {
namespace {

using namespace bps32;

// A waveform read back: the value of each signal, by its full name, at each time it changed.
struct Waveform {
  std::map<std::string, std::map<std::int64_t, std::string>> changes;

  explicit Waveform(const std::string& path) {
    std::ifstream file(path);
    std::map<std::string, std::string> names;
    std::vector<std::string> scopes;
    std::int64_t time = -1;
    for (std::string line; std::getline(file, line);) {
      std::istringstream words(line);
      std::string first, code, skip, name;
      words >> first;
      if (first == "$scope") {
        words >> skip >> name;
        scopes.push_back(name);
      } else if (first == "$upscope") {
        scopes.pop_back();
      } else if (first == "$var") {
        words >> skip >> skip >> code >> name;
        std::string full;
        for (const std::string& s : scopes) full += s + ".";
        names[code] = full + name;
      } else if (first[0] == '#') {
        time = std::stoll(first.substr(1));
      } else if (first[0] == 'b') {
        words >> code;
        changes[names.at(code)][time] = first.substr(1);
      } else if (first[0] == '0' || first[0] == '1') {
        changes[names.at(first.substr(1))][time] = first.substr(0, 1);
      }
    }
  }
  std::string at(const std::string& signal, std::int64_t time) const {
    const auto& values = changes.at(signal);
    auto after = values.upper_bound(time);
    return after == values.begin() ? "?" : std::prev(after)->second;
  }
};

std::string scratch_file(const char* name) {
  return (std::filesystem::path(::testing::TempDir()) /
          (std::string(name) + std::to_string(getpid()) + ".vcd"))
      .string();
}

void run_a_read(Rig& rig) {
  rig.simulate([&] {
    rig.engine->transfer(true, 0, 0x5A, kFnLores);
    rig.run({word({{kBusOp, kBusRead}, {kBusFn, kFnLores}}),
             word({{kDsrc, kDBus}, {kEa, 1}, {kFunc, kPassR}, {kDest, kRam}, {kB, 3}}), word({{kHalt, 1}})},
            100);
  });
}

TEST(ClockedWaveform, ShowsAReadTickByTick) {
  in_child([] {
    MachineOptions options;
    options.vcd_file = scratch_file("read");
    Rig rig(Rig::quiet(), options);
    run_a_read(rig);
    const Waveform w(options.vcd_file);
    std::filesystem::remove(options.vcd_file);
    const auto at = [&](const char* signal, std::int64_t tick) { return w.at(signal, tick * rig.tick()); };
    EXPECT_EQ(at("processor.running", 99), "0");
    EXPECT_EQ(at("processor.running", 100), "1");
    EXPECT_EQ(at("processor.pc", 100), "0");
    EXPECT_EQ(at("processor.pc", 101), "1");
    EXPECT_EQ(at("processor.pc", 104), "1");
    EXPECT_EQ(at("processor.pc", 105), "10");
    EXPECT_EQ(at("bus.grant", 100), "1");
    EXPECT_EQ(at("bus.grant", 101), "0");
    EXPECT_EQ(at("bus.owner", 100), "1");
    EXPECT_EQ(at("bus.data", 100), "1011010");
    EXPECT_EQ(at("frame_memory.card0.busy_ticks", 100), "10");
    EXPECT_EQ(at("frame_memory.card2.busy_ticks", 101), "1");
    EXPECT_EQ(at("frame_memory.card2.busy_ticks", 102), "0");
    EXPECT_EQ(at("processor.stall_cause", 100), "0");
    EXPECT_EQ(at("processor.stall_cause", 103), "11");
    EXPECT_EQ(at("processor.stall_cause", 104), "0");
    EXPECT_EQ(at("processor.ram3", 104), "0");
    EXPECT_EQ(at("processor.ram3", 105), "1011010");
    EXPECT_EQ(at("host.request", 0), "1");
    EXPECT_EQ(at("host.ack", 0), "1");
    EXPECT_EQ(at("host.request", 50), "0");
    EXPECT_EQ(at("host.interrupt", 105), "0");
    EXPECT_EQ(at("host.interrupt", 106), "1");
    EXPECT_EQ(at("video.vertical_blank", 100), "1");
  });
}

TEST(ClockedWaveform, KeepsToItsWindowAndUnitsAndChangesNoCount) {
  in_child([] {
    MachineOptions options;
    options.vcd_file = scratch_file("window");
    options.vcd_from = 101;
    options.vcd_to = 104;
    options.vcd_units = {"processor"};
    Rig rig(Rig::quiet(), options);
    run_a_read(rig);
    const Waveform w(options.vcd_file);
    std::filesystem::remove(options.vcd_file);
    for (const auto& [name, values] : w.changes) {
      EXPECT_EQ(name.rfind("processor.", 0), 0u) << name;
      for (const auto& [time, value] : values)
        EXPECT_TRUE(time >= 101 * rig.tick() && time < 104 * rig.tick()) << name;
    }
    EXPECT_EQ(w.at("processor.pc", 101 * rig.tick()), "1");
    EXPECT_EQ(rig.ticks(), (std::vector<std::int64_t>{0, 4, 5}));
  });
}

TEST(ClockedWaveform, AFileThatCannotBeWrittenOrAnUnknownUnitStopsBeforeTheRun) {
  in_child([] {
    MachineOptions options;
    options.vcd_file = "/nonexistent/x.vcd";
    EXPECT_THROW(Rig(Rig::quiet(), options), UserError);
  });
  in_child([] {
    MachineOptions options;
    options.vcd_file = scratch_file("unit");
    options.vcd_units = {"gpu"};
    EXPECT_THROW(Rig(Rig::quiet(), options), UserError);
    std::filesystem::remove(options.vcd_file);
  });
}

}  // namespace
}  // namespace dendro::rds3000
