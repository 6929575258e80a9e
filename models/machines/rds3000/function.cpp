#include "models/machines/rds3000/function.h"

#include "models/machines/rds3000/loop_finder.h"
#include "models/parts/bps32/bps32_execute.h"
#include "models/parts/ik11b/ik11b_isa.h"
#include "sim/base/check.h"

namespace dendro::rds3000 {
namespace {

struct FunctionPort {
  ProcessorState& processor;
  Devices& devices;
  std::uint64_t words;

  bool bus_busy() const { return false; }
  bool data_ready() const { return true; }
  bool vertical_blank() const { return (words / 4096) % 2 == 0; }
  bool field() const { return false; }
  void start_read(std::uint32_t address, unsigned function) { processor.read_data = devices.read(address, function); }
  void start_write(std::uint32_t address, std::uint32_t data, unsigned function) {
    devices.write(address, data, function);
  }
};

}  // namespace

FunctionEngine::FunctionEngine(const Spec& spec, const MachineOptions& options)
    : spec_(spec),
      options_(options),
      processor_(bps32::power_on(spec.processor)),
      devices_(spec),
      executions_(spec.processor.control_store_words, 0) {}

std::uint32_t FunctionEngine::read(std::uint32_t address, unsigned function) {
  return on_processor_board(address) ? read_processor_board(processor_, address) : devices_.read(address, function);
}

void FunctionEngine::write(std::uint32_t address, std::uint32_t value, unsigned function) {
  if (on_processor_board(address)) {
    write_processor_board(processor_, address, value);
  } else {
    devices_.write(address, value, function);
  }
}

void FunctionEngine::dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
                            std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i) write(address + static_cast<std::uint32_t>(i) * step, words[i], function);
}

void FunctionEngine::dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                              std::uint32_t step) {
  for (std::size_t i = 0; i < count; ++i) words[i] = read(address + static_cast<std::uint32_t>(i) * step, function);
}

void FunctionEngine::command(std::uint32_t bits) {
  const bool run = (bits & ik11b::kRun) != 0, reset_bit = (bits & ik11b::kReset) != 0;
  if (reset_bit) {
    reset(processor_);
  } else {
    processor_.running = run;
  }
}

void FunctionEngine::wait_interrupt() {
  if (processor_.running) run_to_halt();
  DENDRO_CHECK(processor_.interrupt, "the host waits for an interrupt that cannot come");
  processor_.interrupt = false;
}

void FunctionEngine::run_to_halt() {
  std::vector<bps32::Decoded> decoded(bps32::kPageWords);
  const std::size_t base = bps32::page_base(processor_);
  for (std::size_t i = 0; i < decoded.size(); ++i) decoded[i] = bps32::decode(processor_.control[base + i]);
  for (const auto& [index, name] : options_.marks)
    if (index >= base && index < base + bps32::kPageWords) decoded[index - base].marked = true;

  FunctionPort port{processor_, devices_, words_};
  LoopFinder finder;
  const std::uint64_t limit = options_.tick_limit > 0 ? words_ + options_.tick_limit : UINT64_MAX;
  std::uint16_t pc = processor_.pc;
  while (processor_.running) {
    const bps32::Decoded& word = decoded[pc];
    const std::size_t index = base + pc;
    ++executions_[index];
    if (word.marked) marks_.push_back({options_.marks.at(index), static_cast<std::int64_t>(words_)});
    time_dependent_ |= word.reads_time;
    port.words = words_;
    bps32::execute_fast(processor_, word, spec_.processor, port, pc);
    if (++words_ > limit && finder.see(static_cast<std::uint32_t>(index)))
      throw finder.error(options_.tick_limit, options_.symbols);
  }
  processor_.pc = pc;
}

void FunctionEngine::compute(const Work&) {}

void FunctionEngine::phase(std::string_view) {}

std::uint32_t FunctionEngine::peek(std::uint32_t address, unsigned function) const {
  return peek_at(processor_, devices_.video, devices_.memory, address, function);
}

void FunctionEngine::program(std::string_view name, std::uint32_t first) {
  if (const auto known = options_.programs.find(std::string(name)); known != options_.programs.end())
    replace_marks(options_.marks, known->second, first);
}

}  // namespace dendro::rds3000
