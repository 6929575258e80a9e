#include "sim/trace/trace_file.h"

#include <gtest/gtest.h>

#include <random>

#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::trace {
namespace {

Header header() {
  Header h;
  h.machine = "box:small";
  h.boundary = "box.unit";
  h.source = "a scene";
  h.clock_hz = 5e6;
  h.parameters = {{"unit.ticks", "{ value = 2, source = \"X\" }", 0}};
  return h;
}

Record any_record(std::mt19937_64& random) {
  const auto number = [&] { return random() % 2 ? hex(random()) : decimal(static_cast<std::int64_t>(random()) >> (random() % 60)); };
  const auto keys = [&] {
    Keys all;
    for (unsigned i = 0, n = random() % 4; i < n; ++i) all.emplace_back("key" + std::to_string(i), number());
    return all;
  };
  Record record;
  record.at = random() % 2 ? When::at(static_cast<std::int64_t>(random() >> 8)) : When::after(static_cast<std::int64_t>(random() % 100));
  record.op = random() % 2 ? "read" : "write";
  for (unsigned i = 0, n = random() % 3; i < n; ++i) record.values.push_back(number());
  record.keys = keys();
  if (random() % 2) record.answer_at = When::at(static_cast<std::int64_t>(random() % 1000));
  if (random() % 2) record.answer = number();
  record.answer_keys = keys();
  return record;
}

std::vector<std::string> lines_of(Reader& reader) {
  std::vector<std::string> lines;
  Record record;
  while (reader.next(record)) lines.push_back(to_text(record));
  return lines;
}

std::string error_of(const std::string& bytes) {
  try {
    Reader reader(bytes, "t.trace");
    Record record;
    while (reader.next(record)) {
    }
  } catch (const UserError& error) {
    return error.what();
  }
  return "";
}

std::string file(bool as_text, int records, std::vector<std::string>* lines = nullptr) {
  std::mt19937_64 random(7);
  Writer writer("box.unit", 0, INT64_MAX, as_text);
  for (int i = 0; i < records; ++i) {
    const Record record = any_record(random);
    if (lines) lines->push_back(to_text(record));
    writer.add(record);
  }
  return writer.file(header());
}

TEST(TraceFile, BothFormsGiveBackWhatWasWritten) {
  for (const bool as_text : {false, true})
    for (const int records : {1, 2, 100, 20000}) {
      std::vector<std::string> written;
      Reader reader(file(as_text, records, &written), "t");
      EXPECT_EQ(as_text, reader.is_text());
      EXPECT_EQ(written, lines_of(reader));
      reader.rewind();
      EXPECT_EQ(written, lines_of(reader)) << "after rewind";
      EXPECT_EQ("box:small", reader.header().machine);
      EXPECT_EQ("box.unit", reader.header().boundary);
      EXPECT_EQ("a scene", reader.header().source);
      EXPECT_EQ(5e6, reader.header().clock_hz);
      ASSERT_EQ(1u, reader.header().parameters.size());
      EXPECT_EQ("unit.ticks", reader.header().parameters[0].key);
      EXPECT_EQ("{ value = 2, source = \"X\" }", reader.header().parameters[0].text);
    }
}

TEST(TraceFile, ARecordedFileThatIsCutAnywhereIsAnError) {
  for (const bool as_text : {false, true}) {
    const std::string whole = file(as_text, 30);
    for (std::size_t size = 0; size < whole.size(); ++size)
      EXPECT_NE("", error_of(whole.substr(0, size))) << "the first " << size << " of " << whole.size() << " bytes";
  }
}

TEST(TraceFile, ARecordedFileWithAnyByteChangedIsAnError) {
  for (const bool as_text : {false, true}) {
    const std::string whole = file(as_text, 30);
    for (std::size_t at = 0; at < whole.size(); ++at) {
      std::string changed = whole;
      changed[at] = static_cast<char>(changed[at] ^ 0x04);
      EXPECT_NE("", error_of(changed)) << "byte " << at << " of " << whole.size();
    }
  }
}

TEST(TraceFile, ANewerFormatSaysSo) {
  std::string newer = file(false, 3);
  newer.replace(0, 14, "dendro-trace 2");
  EXPECT_EQ("t.trace:1: was written by a newer dendro: format 2, this one reads up to 1", error_of(newer));
}

TEST(TraceFile, BytesThatAreNoTraceSaySo) {
  for (const std::string& bytes : {std::string(), std::string("PNG"), std::string(1000, '\0')})
    EXPECT_NE(std::string::npos, error_of(bytes).find("is no trace")) << bytes.size();
}

TEST(TraceFile, GarbageWithAGoodChecksumIsStillAnError) {
  std::string text = "dendro-trace 1\nmachine box\nboundary box.unit\nrecords 1\nzstd 5\nabcde\n";
  text += "sha256 " + base::sha256(text) + "\n";
  EXPECT_EQ("t.trace: is corrupt: its records cannot be decompressed", error_of(text));
}

TEST(TraceFile, AWrongNumberOfRecordsIsAnError) {
  std::string text = "dendro-trace 1\nmachine box\nboundary box.unit\nrecords 2\n@1 read 3\n";
  text += "sha256 " + base::sha256(text) + "\n";
  EXPECT_EQ("t.trace: is corrupt: 1 records, the header says 2", error_of(text));
}

const std::string kHand = "dendro-trace 1\nmachine box\nboundary box.unit\n";

TEST(HandWritten, CommentsEmptyLinesAndAMissingEndAreFine) {
  Reader reader(kHand + "# what this is\n\n@1 read 0x3 fn=2 -> +4 0x7 wait=0   # so\n\n   # and\n+0 write 1 2\n@5 end", "t");
  EXPECT_EQ((std::vector<std::string>{"@1 read 0x3 fn=2 -> +4 0x7 wait=0", "+0 write 1 2", "@5 end"}), lines_of(reader));
}

TEST(HandWritten, WrongLinesAreErrorsWithTheirLine) {
  const std::pair<const char*, const char*> cases[] = {
      {"read 3\n", "t.trace:4: `read` is no line of a header"},
      {"@1\n", "t.trace:4: the operation is missing"},
      {"@1 read 0x\n", "t.trace:4: `0x` is not a number"},
      {"@1 read 12a\n", "t.trace:4: `12a` is not a number"},
      {"@1 read 0x11112222333344445\n", "t.trace:4: `0x11112222333344445` is not a number"},
      {"@-1 read 1\n", "t.trace:4: `@-1` is no time"},
      {"@99999999999999999999 read 1\n", "is not a number"},
      {"@1 read 1 a=1 2\n", "t.trace:4: `2` is not key=value"},
      {"@1 read 1 a=1 a=2\n", "t.trace:4: `a` stands there twice"},
      {"@1 read 1 ->\n", "t.trace:4: nothing stands after ->"},
      {"@1 read 1 -> 1 2\n", "t.trace:4: `2` is not key=value"},
      {"@1 read 1\nwrite 2\n", "t.trace:5: a record begins with its time"}};
  for (const auto& [line, wanted] : cases) {
    const std::string error = error_of(kHand + line);
    EXPECT_NE(std::string::npos, error.find(wanted)) << line << " gives: " << error;
  }
}

TEST(HandWritten, ANumberWithAPointIsASingleAndComesBack) {
  std::mt19937_64 random(5);
  Record record, again;
  record.at = When::at(1);
  record.op = "go";
  for (int n = 0; n < 2000; ++n) {
    const auto bits = static_cast<std::uint32_t>(random());
    record.keys = {{"a", single(bits)}, {"b", single(bits & 0x80000000)}};
    ASSERT_TRUE(parse_record(to_text(record), "t", 1, again));
    ASSERT_EQ(bits, static_cast<std::uint32_t>(again.key("a"))) << to_text(record);
    ASSERT_EQ(to_text(record), to_text(again));
  }
  ASSERT_TRUE(parse_record("@0 go a=0.5 b=-1.0e-3", "t", 1, again));
  EXPECT_EQ(0x3f000000, again.key("a"));
  EXPECT_EQ("@0 go a=0.5 b=-0.001", to_text(again));
  for (const char* wrong : {"@0 go a=1.x", "@0 go a=1.0e99", "@0 go a=.", "@1.0 go a=1"})
    EXPECT_THROW(parse_record(wrong, "t", 1, again), UserError) << wrong;
}

TEST(HandWritten, OnlyTheBoundarysOperationsAndKeysAreAdmitted) {
  const Boundary boundary{"box.unit", {{"read", 1, 2, {"fn"}, true, false, {"wait"}}, {"go", 0, 0, {}, false, true, {}}}};
  const std::pair<const char*, const char*> cases[] = {
      {"@1 fly\n", "t.trace:4: box.unit has no operation `fly`: read, go"},
      {"@1 read\n", "t.trace:4: `read` takes 1 to 2 values, not 0"},
      {"@1 read 1 2 3\n", "t.trace:4: `read` takes 1 to 2 values, not 3"},
      {"@1 read 1 wait=1\n", "t.trace:4: wait: is no key here of `read`: fn"},
      {"@1 read 1 -> +1 fn=1\n", "t.trace:4: fn: is no key here of `read`: wait"},
      {"@1 read 1 -> 7\n", "t.trace:4: `read` has no answer data"},
      {"@1 go -> +1 7\n", "t.trace:4: `go` has no answer time"}};
  for (const auto& [line, wanted] : cases) {
    Reader reader(kHand + line, "t.trace");
    reader.expect(boundary);
    Record record;
    try {
      reader.next(record);
      ADD_FAILURE() << line << " was taken";
    } catch (const UserError& error) {
      EXPECT_STREQ(wanted, error.what());
    }
  }
}

}  // namespace
}  // namespace dendro::trace
