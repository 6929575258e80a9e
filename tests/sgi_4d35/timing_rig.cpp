#include "tests/sgi_4d35/timing_rig.h"

#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <stdexcept>

#include "models/machines/sgi_4d35/clocked.h"
#include "models/machines/sgi_4d35/cycle.h"

namespace dendro::sgi_4d35 {
namespace {

constexpr std::uint32_t kProgram = 0x80010800;  // not at the vectors' indices of the cache

void put(int file, const void* bytes, std::size_t count) {
  for (const char* at = static_cast<const char*>(bytes); count != 0;) {
    const ssize_t done = write(file, at, count);
    if (done <= 0) throw std::runtime_error("pipe");
    at += done, count -= static_cast<std::size_t>(done);
  }
}

void get(int file, void* bytes, std::size_t count) {
  for (char* at = static_cast<char*>(bytes); count != 0;) {
    const ssize_t done = read(file, at, count);
    if (done <= 0) throw std::runtime_error("the run's process has said why it failed");
    at += done, count -= static_cast<std::size_t>(done);
  }
}

void put_number(int file, std::uint64_t number) { put(file, &number, sizeof number); }
std::uint64_t get_number(int file) {
  std::uint64_t number = 0;
  get(file, &number, sizeof number);
  return number;
}

std::vector<std::uint8_t> bytes_of(const Words& words) {
  std::vector<std::uint8_t> bytes;
  for (const std::uint32_t word : words)
    for (unsigned i = 0; i < 4; ++i) bytes.push_back(static_cast<std::uint8_t>(word >> (24 - 8 * i)));
  return bytes;
}

void run_and_send(int file, Level level, const Spec& spec, const ProgramImage& image, std::uint64_t limit) {
  StopService services;
  RunOptions options;
  std::vector<Retired> retired;
  r3000::State state;
  options.retired = &retired;
  options.final_state = &state;
  if (level != Level::kClocked && level != Level::kCycle) throw std::runtime_error("no such level");
  const ProgramResult result = level == Level::kCycle ? run_cycle(spec, image, services, limit, options)
                                                      : run_clocked(spec, image, services, limit, options);
  put_number(file, retired.size());
  put(file, retired.data(), retired.size() * sizeof(Retired));
  put_number(file, static_cast<std::uint64_t>(result.cycles));
  put_number(file, result.instructions);
  put_number(file, result.stopped);
  put(file, &state, sizeof state);
  put_number(file, services.digest);
  std::string counters;
  for (const UnitStats& unit : result.units)
    for (const auto& [name, value] : unit.values)
      counters += unit.unit.substr(unit.unit.find('.') + 1) + "." + name + " " + std::to_string(value) + " ";
  put_number(file, counters.size());
  put(file, counters.data(), counters.size());
}

Ran receive(int file) {
  Ran ran;
  ran.retired.resize(get_number(file));
  get(file, ran.retired.data(), ran.retired.size() * sizeof(Retired));
  ran.cycles = get_number(file);
  ran.instructions = get_number(file);
  ran.stopped = get_number(file) != 0;
  get(file, &ran.state, sizeof ran.state);
  ran.memory_digest = get_number(file);
  std::string text(get_number(file), ' ');
  get(file, text.data(), text.size());
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t name = text.find(' ', at), end = text.find(' ', name + 1);
    ran.counters[text.substr(at, name - at)] = std::stoull(text.substr(name + 1, end - name - 1));
    at = end + 1;
  }
  return ran;
}

}  // namespace

Spec small() {
  Spec spec;
  spec.instruction_cache.refill_words = 8;
  spec.main_bytes = 1 << 20;
  spec.clock_hz = 36e6;
  return spec;
}

std::int64_t Ran::clock_of(std::uint32_t pc, std::size_t n) const {
  for (const Retired& word : retired)
    if (word.pc == pc && n-- == 0) return static_cast<std::int64_t>(word.clock);
  return -1;
}

ProgramImage image_of(const Memory& memory, std::uint32_t start) {
  ProgramImage image;
  for (const auto& [address, words] : memory)
    if (!words.empty()) image.chunks.push_back({address & 0x1FFFFFFF, bytes_of(words)});
  image.start = start;
  return image;
}

std::uint64_t digest_of(const std::vector<std::uint8_t>& bytes) {
  std::uint64_t digest = 0xCBF29CE484222325;  // FNV-1a
  for (const std::uint8_t byte : bytes) digest = (digest ^ byte) * 0x100000001B3;
  return digest;
}

Ran run_words(Level level, const Spec& spec, const Memory& memory, std::uint32_t start, std::uint64_t limit) {
  const ProgramImage image = image_of(memory, start);
  int ends[2];
  if (pipe(ends) != 0) throw std::runtime_error("pipe");
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    int status = 0;
    try {
      run_and_send(ends[1], level, spec, image, limit);
    } catch (const std::exception& e) {
      std::fprintf(stderr, "%s\n", e.what());
      status = 1;
    }
    std::fflush(nullptr);
    _exit(status);
  }
  close(ends[1]);
  Ran ran;
  std::string problem;
  try {
    ran = receive(ends[0]);
  } catch (const std::exception& e) {
    problem = e.what();
  }
  close(ends[0]);
  waitpid(child, nullptr, 0);
  if (!problem.empty()) throw std::runtime_error(problem);
  return ran;
}

std::string state_difference(const r3000::State& a, const r3000::State& b) {
  for (unsigned i = 0; i < 32; ++i)
    if (a.r[i] != b.r[i]) return fmt::format("r{}: 0x{:08x} and 0x{:08x}", i, a.r[i], b.r[i]);
  for (unsigned i = 0; i < 32; ++i)
    if (a.fpu.r[i] != b.fpu.r[i]) return fmt::format("f{}: 0x{:08x} and 0x{:08x}", i, a.fpu.r[i], b.fpu.r[i]);
  const std::pair<const char*, std::pair<std::uint32_t, std::uint32_t>> rest[] = {
      {"hi", {a.hi, b.hi}},
      {"lo", {a.lo, b.lo}},
      {"pc", {a.pc, b.pc}},
      {"next_pc", {a.next_pc, b.next_pc}},
      {"fcr31", {a.fpu.control, b.fpu.control}},
      {"Status", {a.status, b.status}},
      {"Cause", {a.cause, b.cause}},
      {"EPC", {a.epc, b.epc}},
      {"BadVAddr", {a.bad_vaddr, b.bad_vaddr}},
      {"EntryHi", {a.entry_hi, b.entry_hi}},
      {"EntryLo", {a.entry_lo, b.entry_lo}},
      {"Index", {a.index, b.index}},
      {"Context", {a.context, b.context}},
      {"in_slot", {a.in_slot, b.in_slot}},
      {"lines", {a.lines, b.lines}}};
  for (const auto& [name, values] : rest)
    if (values.first != values.second)
      return fmt::format("{}: 0x{:08x} and 0x{:08x}", name, values.first, values.second);
  const std::pair<const char*, std::pair<std::uint64_t, std::uint64_t>> events[] = {
      {"instructions", {a.instructions, b.instructions}},
      {"exceptions", {a.exceptions, b.exceptions}},
      {"tlb_refills", {a.tlb_refills, b.tlb_refills}}};
  for (const auto& [name, values] : events)
    if (values.first != values.second) return fmt::format("{}: {} and {}", name, values.first, values.second);
  for (unsigned i = 0; i < r3000::kTlbEntries; ++i)
    if (a.tlb[i].hi != b.tlb[i].hi || a.tlb[i].lo != b.tlb[i].lo) return fmt::format("TLB entry {}", i);
  return "";
}

void expect_counters(const Ran& ran, const std::map<std::string, std::uint64_t>& expected) {
  for (const auto& [name, value] : expected) EXPECT_EQ(value, ran.counters.at(name)) << name;
}

void Timed::run(Level level, const Words& words) {
  Words code = {
      high(kT0, 0x2000),      to_cp0(kT0, r3000::kStatus), high(kData, 0x8002),
      high(kCold, 0x8004),    high(kElsewhere, 0x8002),    or_immediate(kElsewhere, kElsewhere, 0x8000),
      high(kMapped, 0x0010),  high(kUncached, 0xA003),     high(kService, 0xBF00),
      high(kNothing, 0xBE00), add_immediate(kT1, 0, 3)};
  code.insert(code.end(), setup.begin(), setup.end());
  constexpr unsigned kPasses = 23, kJunk = 25;
  code.push_back(add_immediate(kPasses, 0, 2));
  const std::size_t head = code.size();
  for (const std::uint32_t word :
       {add_immediate(kCold, kCold, 0x1000), add_immediate(kMapped, kMapped, 0x1000), load(kJunk, kUncached),
        kNop, divide(), from_lo(kJunk), kNop, kNop, kNop})
    code.push_back(word);
  while (code.size() % spec.instruction_cache.refill_words != 0) code.push_back(kNop);
  body = kProgram + static_cast<std::uint32_t>(4 * code.size());
  code.insert(code.end(), words.begin(), words.end());
  code.push_back(kNop);
  code.push_back(add_immediate(kPasses, kPasses, -1));
  const auto back = static_cast<int>(head) - static_cast<int>(code.size()) - 1;
  for (const std::uint32_t word : {r3000::i_word(r3000::kMajorBne, 0, kPasses, back), kNop,
                                   load(kJunk, kUncached), store(0, kService), kNop, kNop, kNop})
    code.push_back(word);
  ran = run_words(level, spec,
                  {{kProgram, code}, {r3000::kGeneralVector, handler}, {r3000::kUtlbVector, refill}},
                  kProgram, 10000);
  EXPECT_TRUE(ran.stopped);
}

std::vector<std::int64_t> Timed::clocks(Level level, const Words& words) {
  run(level, words);
  std::vector<std::int64_t> clocks;
  for (std::uint32_t i = 0; i < words.size(); ++i) clocks.push_back(clock_at(body + 4 * i));
  return clocks;
}

std::int64_t Timed::clock_at(std::uint32_t pc) const {
  const std::int64_t first = ran.clock_of(body, 1);
  for (const Retired& word : ran.retired)
    if (word.pc == pc && static_cast<std::int64_t>(word.clock) >= first)
      return static_cast<std::int64_t>(word.clock) - first;
  return -1;
}

}  // namespace dendro::sgi_4d35
