#include "models/machines/sgi_4d35/boundaries.h"

#include <fmt/format.h>

#include "sim/base/check.h"

namespace dendro::sgi_4d35 {
namespace {

using trace::Op;

std::vector<std::string> counter_names(bool with_caches) {
  std::vector<std::string> names;
  for (const auto& [name, value] : counter_keys({}, with_caches)) names.emplace_back(name);
  return names;
}

Op holds() { return {"holds", 2, 1 + kMostBlockWords, {}, false, false, {}}; }
Op word() { return {"word", 1, 1, {}, false, true, {}}; }
Op counters(bool with_caches) { return {"counters", 0, 0, {}, false, false, counter_names(with_caches)}; }
Op set_page() { return {"set_page", 1, 1, {}, false, false, {}}; }

trace::Boundary memory() {
  std::vector<std::string> of_block = {"start"};
  for (unsigned i = 1; i < kMostBlockWords; ++i) of_block.push_back(word_key(i));
  return {kMemoryBoundary,
          {{"read", 1, 1, {"words", "fetch"}, true, true, of_block},
           {"read_uncached", 1, 1, {"fetch"}, true, true, {"start"}},
           {"write", 1, 2, {"mask", "leaves"}, true, false, {"start", "done"}},
           holds(),
           word(),
           counters(false),
           set_page()}};
}

trace::Boundary processor() {
  return {kProcessorBoundary,
          {{"fetch", 1, 1, {"uncached"}, true, true, {"miss"}},
           {"fetch_again", 0, 0, {}, true, false, {}},
           {"load", 1, 1, {"uncached"}, true, true, {"miss"}},
           {"store", 1, 2, {"size", "partial", "uncached", "leaves"}, true, false, {"miss"}},
           {"isolated_load", 0, 0, {}, false, false, {}},
           {"isolated_store", 1, 1, {"size", "partial", "swapped", "leaves"}, false, false, {}},
           holds(),
           word(),
           counters(true),
           set_page(),
           {"set_instruction", 1, 1, {"count"}, false, false, {}},
           {"set_data", 1, 1, {"count"}, false, false, {}}}};
}

}  // namespace

std::string word_key(unsigned word) { return fmt::format("w{}", word); }

std::vector<std::pair<const char*, std::uint64_t>> counter_keys(const Counters& c, bool with_caches) {
  std::vector<std::pair<const char*, std::uint64_t>> keys;
  if (with_caches)
    keys = {{"instruction_accesses", c.instruction_accesses},
            {"instruction_misses", c.instruction_misses},
            {"data_accesses", c.data_accesses},
            {"data_misses", c.data_misses}};
  keys.insert(keys.end(), {{"busy", c.memory.busy},
                           {"reads", c.memory.reads},
                           {"read_words", c.memory.read_words},
                           {"writes", c.memory.writes},
                           {"page_writes", c.memory.page_writes},
                           {"overtaken", c.memory.overtaken}});
  return keys;
}

std::vector<trace::Boundary> boundaries() { return {memory(), processor()}; }

trace::ReplayResult replay(const Spec& spec, Level level, trace::Reader& trace) {
  const std::string& name = trace.header().boundary;
  if (name == kMemoryBoundary) return replay_memory(spec, level, trace);
  DENDRO_CHECK(name == kProcessorBoundary, "{}", name);
  return replay_processor(spec, level, trace);
}

}  // namespace dendro::sgi_4d35
