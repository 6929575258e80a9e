#include "models/parts/ik11b/ik11b_shell.h"

#include "models/parts/ik11b/ik11b_isa.h"
#include "sim/base/check.h"

namespace dendro::ik11b {
namespace {

std::int64_t now_ps() { return static_cast<std::int64_t>(sc_core::sc_time_stamp().value()); }

}  // namespace

Shell::Shell(sc_core::sc_module_name name, const HostSpec& spec, Target& target,
             std::function<void(HostPort&)> program)
    : sc_module(name), spec_(spec), target_(target), program_(std::move(program)) {
  SC_HAS_PROCESS(Shell);
  SC_THREAD(thread);
  set_stack_size(1 << 20);
  // sc_stop reports itself on standard output, where a program's own output belongs.
  sc_core::sc_report_handler::set_actions("/OSCI/SystemC", sc_core::SC_INFO, sc_core::SC_DO_NOTHING);
}

void Shell::thread() {
  try {
    program_(*this);
  } catch (...) {
    // An exception that leaves an SC_THREAD would become a SystemC report; the owner rethrows this one.
    error_ = std::current_exception();
  }
  ended_ps_ = now_ps();
  sc_core::sc_stop();
}

void Shell::pause(std::int64_t ps) {
  busy_ps_ += static_cast<std::uint64_t>(ps);
  if (on_busy_) on_busy_(now_ps(), now_ps() + ps);
  if (ps > 0) sc_core::wait(sc_core::sc_time::from_value(static_cast<std::uint64_t>(ps)));
}

std::uint32_t Shell::read(std::uint32_t address, unsigned function) {
  pause(kRegistersPerWord * spec_.register_ps);
  return target_.transfer(false, address, 0, function);
}

void Shell::write(std::uint32_t address, std::uint32_t value, unsigned function) {
  pause(kRegistersPerWord * spec_.register_ps);
  target_.transfer(true, address, value, function);
}

// Word i asks for the bus i word times after the start of its transfer, or when word i - 1 is complete.
template <class Move>
void Shell::dma(std::size_t count, const Move& move) {
  constexpr std::size_t kWords = kMaxTransferBytes / 4;
  for (std::size_t first = 0; first < count; first += kWords) {
    pause(spec_.dma_start_ps);
    const std::int64_t start = now_ps();
    const std::size_t last = std::min(count, first + kWords);
    for (std::size_t i = first; i < last; ++i) {
      const std::int64_t due = start + static_cast<std::int64_t>(i - first) * spec_.word_ps;
      if (due > now_ps()) pause(due - now_ps());
      move(i);
    }
    dma_words_ += last - first;
  }
}

void Shell::dma_to(std::uint32_t address, const std::uint32_t* words, std::size_t count, unsigned function,
                   std::uint32_t step) {
  dma(count, [&](std::size_t i) {
    target_.transfer(true, address + static_cast<std::uint32_t>(i) * step, words[i], function);
  });
}

void Shell::dma_from(std::uint32_t address, std::uint32_t* words, std::size_t count, unsigned function,
                     std::uint32_t step) {
  dma(count, [&](std::size_t i) {
    words[i] = target_.transfer(false, address + static_cast<std::uint32_t>(i) * step, 0, function);
  });
}

void Shell::command(std::uint32_t bits) {
  pause(spec_.register_ps);
  target_.command((bits & kRun) != 0, (bits & kReset) != 0);
}

void Shell::wait_interrupt() {
  target_.host_sleeps();
  while (!target_.interrupt()) {
    if (target_.error()) std::rethrow_exception(target_.error());
    DENDRO_CHECK(target_.running(), "the host waits for an interrupt that cannot come");
    sc_core::wait(target_.interrupt_event());
  }
  target_.clear_interrupt();
  pause(spec_.interrupt_ps);
}

void Shell::compute(const Work& work) {
  pause(static_cast<std::int64_t>(work.flops) * spec_.flop_ps +
        static_cast<std::int64_t>(work.instructions) * spec_.instruction_ps +
        static_cast<std::int64_t>(work.program_loads) * spec_.program_load_ps);
}

void Shell::phase(std::string_view name) { phases_.push_back({std::string(name), now_ps()}); }

}  // namespace dendro::ik11b
