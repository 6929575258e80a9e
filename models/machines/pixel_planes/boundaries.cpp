#include "models/machines/pixel_planes/boundaries.h"

#include "sim/base/check.h"
#include "sim/trace/digest.h"

namespace dendro::pixel_planes {
namespace {

using trace::decimal;
using trace::hex;

const std::vector<std::string> kOffsets = {"at1", "at2", "at3", "at4", "at5"};
const std::vector<std::string> kProgress = {"landed", "fifo", "taken"};

std::vector<std::string> with_offsets(std::vector<std::string> keys) {
  keys.insert(keys.end(), kOffsets.begin(), kOffsets.end());
  return keys;
}

trace::Boundary commands() {
  return {kCommandsBoundary,
          {{"command", 0, 0, with_offsets({"entry", "fraction", "guard", "a", "b", "c", "constant", "high"}), true, false,
            kProgress, {"a", "b", "c"}},
           {"register", 2, 2, {}, true, false, kProgress},
           {"word", 1, 1, {}, true, false, kProgress},
           {"store", 2, 2, {}, false, false, {}},
           {"status", 0, 0, {}, false, true, {}},
           {"idle", 0, 0, {}, true, false, {"digest"}},
           {"pixel", 1, 2, {}, false, true, {}},
           {"plane", 1, 1, {}, false, false, {"digest", "ones"}},
           {"set_control", 2, 2, {"count"}, false, false, {}},
           {"set_register", 2, 2, {}, false, false, {}},
           {"set_memory", 3, 3, {"count"}, false, false, {}}}};
}

trace::Boundary array() {
  return {kArrayBoundary,
          {{"word", 0, 0, {"function", "x", "y", "data", "source", "read_a", "write_a", "read_b", "write_b", "tree"}, true,
            false, {}},
           {"stream", 3, 3, {}, false, false, {}},
           {"state", 0, 0, {}, false, false, {"enable", "enabled", "carry", "data", "memory"}},
           {"pixel", 1, 2, {}, false, true, {"enable", "carry", "data"}},
           {"plane", 1, 1, {}, false, false, {"digest", "ones"}},
           {"set_memory", 3, 3, {"count"}, false, false, {}},
           {"set_enable", 2, 2, {"count"}, false, false, {}},
           {"set_carry", 2, 2, {"count"}, false, false, {}},
           {"set_data", 2, 2, {"count"}, false, false, {}}}};
}

std::uint32_t bits_of(const trace::Record& record, const char* key) {
  return static_cast<std::uint32_t>(record.key(key));
}

}  // namespace

std::vector<trace::Boundary> boundaries() { return {commands(), array()}; }

trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace) {
  const std::string& name = trace.header().boundary;
  if (name == kCommandsBoundary) return replay_commands(spec, level, trace);
  DENDRO_CHECK(name == kArrayBoundary, "{}", name);
  return replay_array(spec, level, trace);
}

igc::ArrayWord word_of(const trace::Record& record) {
  igc::ArrayWord w;
  w.function = static_cast<igc::Function>(record.key("function"));
  w.x = static_cast<igc::Operand>(record.key("x")), w.y = static_cast<igc::Operand>(record.key("y"));
  w.data = static_cast<igc::DataOp>(record.key("data"));
  w.source = static_cast<igc::Source>(record.key("source"));
  w.read_a = record.has("read_a"), w.write_a = record.has("write_a");
  w.read_b = record.has("read_b"), w.write_b = record.has("write_b");
  w.address_a = static_cast<std::uint8_t>(record.key(w.read_a ? "read_a" : "write_a"));
  w.address_b = static_cast<std::uint8_t>(record.key(w.read_b ? "read_b" : "write_b"));
  w.tree = record.key("tree") != 0;
  return w;
}

trace::Keys keys_of(const igc::ArrayWord& w) {
  trace::Keys keys;
  const auto add = [&](const char* key, auto value) {
    if (static_cast<unsigned>(value) != 0) keys.emplace_back(key, decimal(static_cast<std::int64_t>(value)));
  };
  const auto port = [&](const char* key, bool used, unsigned address) {
    if (used) keys.emplace_back(key, decimal(address));
  };
  add("function", w.function), add("x", w.x), add("y", w.y), add("data", w.data), add("source", w.source);
  port("read_a", w.read_a, w.address_a), port("write_a", w.write_a, w.address_a);
  port("read_b", w.read_b, w.address_b), port("write_b", w.write_b, w.address_b);
  add("tree", w.tree);
  return keys;
}

std::vector<std::uint32_t> fifo_words_of(const trace::Record& record) {
  igc::Header header;
  if (record.op == "register") {
    header.register_write = true;
    header.register_number = static_cast<unsigned>(record.value(0)), header.value = static_cast<unsigned>(record.value(1));
    return {igc::pack(header)};
  }
  header.entry = static_cast<unsigned>(record.key("entry"));
  header.fraction = static_cast<unsigned>(record.key("fraction")), header.guard = static_cast<unsigned>(record.key("guard"));
  header.expression = record.has("a") || record.has("b") || record.has("c");
  header.constant = record.has("constant"), header.long_constant = record.has("high");
  std::vector<std::uint32_t> words{igc::pack(header)};
  if (header.expression)
    for (const char* key : {"a", "b", "c"}) words.push_back(bits_of(record, key));
  if (header.constant) words.push_back(bits_of(record, "constant"));
  if (header.long_constant) words.push_back(bits_of(record, "high"));
  return words;
}

bool record_of(const std::vector<std::uint32_t>& fifo_words, trace::Record& record) {
  const igc::Header header = igc::unpack_header(fifo_words.front());
  if (igc::pack(header) != fifo_words.front()) return false;
  if (header.register_write) {
    record.op = "register";
    record.values = {decimal(header.register_number), decimal(header.value)};
    return true;
  }
  record.op = "command";
  record.keys = {{"entry", decimal(header.entry)}};
  if (header.fraction != 0) record.keys.emplace_back("fraction", decimal(header.fraction));
  if (header.guard != 0) record.keys.emplace_back("guard", decimal(header.guard));
  std::size_t next = 1;
  if (header.expression)
    for (const char* key : {"a", "b", "c"}) record.keys.emplace_back(key, trace::single(fifo_words.at(next++)));
  if (header.constant) record.keys.emplace_back("constant", hex(fifo_words.at(next++)));
  if (header.long_constant) record.keys.emplace_back("high", hex(fifo_words.at(next++)));
  return true;
}

std::uint64_t digest_of(const std::vector<Plane>& planes) {
  Plane all;
  for (const Plane& plane : planes) all.insert(all.end(), plane.begin(), plane.end());
  return trace::digest(all);
}

std::int64_t ones_of(const Plane& plane) {
  std::int64_t ones = 0;
  for (const std::uint64_t word : plane) ones += __builtin_popcountll(word);
  return ones;
}

}  // namespace dendro::pixel_planes
