#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include "models/machines/pixel_planes/pixel_planes.h"
#include "models/machines/rds3000/rds3000.h"
#include "models/machines/sgi_4d35/sgi_4d35.h"
#include "sim/base/error.h"
#include "sim/study/trace.h"

/// Replays every trace of the repository.
namespace dendro::study {
namespace {

constexpr const char* kMachines[] = {"pixel_planes", "rds3000", "sgi_4d35"};

/// `file`: from the folder of all traces on, as "rds3000/nested-loop.txt".
struct Entry {
  std::string file, record;
  bool repeat = false;
};

Catalogue catalogue() {
  return {{rds3000::rds3000_type(), pixel_planes::pixel_planes_type(), sgi_4d35::sgi_4d35_type()}, algorithms(), SHARE};
}

std::string path_of(const std::string& file) { return std::string(TRACES) + "/" + file; }

std::string text_of(const config::Node& entry, const std::string& key) {
  const config::Node* node = entry.member(key);
  return node ? std::get<std::string>(node->value) : "";
}

std::vector<Entry> manifest() {
  std::vector<Entry> entries;
  for (const std::string machine : kMachines) {
    const std::string path = path_of(machine + "/manifest.toml");
    const config::Node root = config::parse_toml(config::read_text({false, path}, {}), path);
    for (const config::Node& entry : root.member("trace")->items)
      entries.push_back({machine + "/" + text_of(entry, "file"), text_of(entry, "record"), entry.member("repeat") != nullptr});
  }
  return entries;
}

std::vector<std::string> files() {
  std::vector<std::string> names;
  for (const Entry& entry : manifest()) names.push_back(entry.file);
  return names;
}

std::vector<std::string> hand_written() {
  std::vector<std::string> names = files();
  names.erase(std::remove_if(names.begin(), names.end(),
                             [](const std::string& name) { return name.find(".txt") == std::string::npos; }),
              names.end());
  return names;
}

std::string printable(const std::string& file) {
  std::string name = file;
  std::replace_if(name.begin(), name.end(), [](char c) { return !std::isalnum(static_cast<unsigned char>(c)); }, '_');
  return name;
}

TEST(Manifest, ListsEveryTraceOfItsFolderAndNoOther) {
  std::set<std::string> listed, there;
  for (const std::string& name : files()) EXPECT_TRUE(listed.insert(name).second) << name << " twice";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(TRACES)) {
    const std::string ending = entry.path().extension().string();
    if (ending == ".trace" || ending == ".txt") there.insert(entry.path().lexically_relative(TRACES).string());
  }
  EXPECT_EQ(listed, there);
  EXPECT_GE(hand_written().size(), 34u);
}

class EveryTrace : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryTrace, IsWhatItsUnitDoesAtBothLevels) {
  for (const char* level : {"cycle", "clocked"}) {
    const ReplayOutput output = replay_trace(catalogue(), {path_of(GetParam()), level, {}});
    EXPECT_FALSE(output.result.difference.has_value()) << level << ": " << *output.result.difference;
    EXPECT_GT(output.result.transactions, 0);
    EXPECT_GT(output.result.cycles, 0);
  }
}

INSTANTIATE_TEST_SUITE_P(Traces, EveryTrace, ::testing::ValuesIn(files()),
                         [](const auto& instance) { return printable(instance.param); });

/// A trace as text with one expectation changed.
struct Changed {
  std::string text;
  int line = 0;
};

std::vector<Changed> every_expectation_changed(const trace::Header& header, const std::vector<trace::Record>& records) {
  std::vector<Changed> all;
  const int header_lines = static_cast<int>(std::count_if(header.settings.begin(), header.settings.end(), [](auto&) { return true; })) + 4;
  const auto with = [&](std::size_t changed, const trace::Record& replacement) {
    std::string text = trace::header_text(header);
    for (std::size_t i = 0; i < records.size(); ++i) text += trace::to_text(i == changed ? replacement : records[i]) + "\n";
    all.push_back({text, header_lines + static_cast<int>(changed) + 1});
  };
  for (std::size_t i = 0; i < records.size(); ++i) {
    trace::Record record = records[i];
    if (record.answer_at.given()) {
      ++record.answer_at.ticks;
      with(i, record);
      record = records[i];
    }
    if (record.answer) {
      record.answer->value ^= 1;
      with(i, record);
      record = records[i];
    }
    for (auto& key : record.answer_keys) {
      key.second.value ^= 1;
      with(i, record);
      key.second.value ^= 1;
    }
  }
  return all;
}

class HandWrittenTrace : public ::testing::TestWithParam<std::string> {};

TEST_P(HandWrittenTrace, AnyExpectationThatIsChangedIsFoundAtItsLine) {
  const auto reader = open_trace(catalogue(), path_of(GetParam()));
  std::vector<trace::Record> records;
  trace::Record record;
  while (reader->next(record)) records.push_back(record);
  const std::vector<Changed> all = every_expectation_changed(reader->header(), records);
  EXPECT_FALSE(all.empty()) << "it expects nothing";
  const std::string path = ::testing::TempDir() + "dendro_changed_" + printable(GetParam()) + ".txt";
  for (const Changed& changed : all) {
    std::ofstream(path) << changed.text;
    for (const char* level : {"cycle", "clocked"}) {
      const ReplayOutput output = replay_trace(catalogue(), {path, level, {}});
      ASSERT_TRUE(output.result.difference.has_value()) << level << ", line " << changed.line << " of\n" << changed.text;
      EXPECT_EQ(0u, output.result.difference->find(path + ":" + std::to_string(changed.line) + ":"))
          << level << ", line " << changed.line << ": " << *output.result.difference;
    }
  }
  std::remove(path.c_str());
}

INSTANTIATE_TEST_SUITE_P(Traces, HandWrittenTrace, ::testing::ValuesIn(hand_written()),
                         [](const auto& instance) { return printable(instance.param); });

/// The arguments of a manifest's `record` line that records a program of the folder of the machine.
RecordArguments arguments_of(const Entry& entry) {
  RecordArguments arguments;
  std::istringstream words(entry.record);
  std::string word;
  while (words >> word) {
    std::string value;
    words >> value;
    if (word == "--exec") {
      arguments.exec.machine = value;
      words >> value;
      arguments.exec.program = path_of(entry.file.substr(0, entry.file.find('/') + 1) + value);
      while (words >> std::ws && words.peek() != '-' && words >> value) arguments.exec.arguments.push_back(value);
    } else if (word == "--set") {
      arguments.exec.settings.push_back(value);
    } else if (word == "--boundary") {
      arguments.boundary = value;
    } else if (word == "--from") {
      arguments.from = std::stoll(value);
    } else if (word == "--to") {
      arguments.to = std::stoll(value);
    } else {
      ADD_FAILURE() << word;
    }
  }
  return arguments;
}

std::string printed(trace::Reader& reader) {
  std::string text = trace::header_text(reader.header());
  trace::Record record;
  while (reader.next(record)) text += trace::to_text(record) + "\n";
  return text;
}

TEST(Repeated, RecordingAProgramAgainGivesTheSameTrace) {
  int repeated = 0;
  for (const Entry& entry : manifest()) {
    if (!entry.repeat) continue;
    ++repeated;
    SCOPED_TRACE(entry.file);
    trace::Reader again(record_trace(catalogue(), arguments_of(entry), nullptr).bytes, "again");
    const auto kept = open_trace(catalogue(), path_of(entry.file));
    EXPECT_EQ(printed(*kept), printed(again));
  }
  EXPECT_GE(repeated, 8);
}

TEST(WhatIf, AnotherMachineDiffersFromTheTraceAndSaysWhere) {
  const auto difference = [](const char* file, const char* setting) {
    const ReplayOutput output = replay_trace(catalogue(), {path_of(file), "cycle", {setting}});
    return output.result.difference.value_or("");
  };
  EXPECT_NE(std::string::npos, difference("rds3000/waits-for-data.txt", "processor.accesses_in_flight=0").find("waits-for-data.txt:15:"));
  EXPECT_NE(std::string::npos, difference("rds3000/writes-to-one-card.txt", "frame_memory.card_busy_ticks=3").find("writes-to-one-card.txt:7:"));
  EXPECT_NE(std::string::npos, difference("rds3000/dma-pace.txt", "host.dma_start_ms=2.0").find("dma-pace.txt:8:"));
  EXPECT_NE(std::string::npos, difference("sgi_4d35/writes-in-a-page.txt", "memory.page_write_cycles=4").find("writes-in-a-page.txt:7:"));
  EXPECT_NE(std::string::npos, difference("sgi_4d35/a-full-buffer-waits.txt", "write_buffer.entries=5").find("a-full-buffer-waits.txt:10:"));
  EXPECT_NE(std::string::npos, difference("sgi_4d35/conflicts.txt", "data_cache.size_bytes=131072").find("conflicts.txt:8:"));
  EXPECT_NE(std::string::npos, difference("sgi_4d35/streaming.txt", "instruction_cache.streaming=false").find("streaming.txt:8:"));
  EXPECT_NE(std::string::npos, difference("pixel_planes/a-command-is-taken.txt", "translator.setup_clocks=5").find("a-command-is-taken.txt:19:"));
  EXPECT_NE(std::string::npos, difference("pixel_planes/a-full-fifo-stalls.txt", "fifo.depth_words=9").find("a-full-fifo-stalls.txt:25:"));
  EXPECT_NE(std::string::npos, difference("pixel_planes/two-ports-add.txt", "array.ports=1").find("two-ports-add.txt:22:"));
  EXPECT_NE(std::string::npos, difference("pixel_planes/a-plane-in-pixels.txt", "array.video_interval_ns=1356.3").find("a-plane-in-pixels.txt:19:"));
}

}  // namespace
}  // namespace dendro::study
