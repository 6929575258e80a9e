#include "models/machines/rds3000/clocked_vcd.h"

#include <fmt/format.h>

#include "models/machines/rds3000/clocked.h"

namespace dendro::rds3000 {
ClockedVcd::ClockedVcd(const ClockedEngine& engine, const MachineOptions& options)
    : engine_(engine),
      from_(options.vcd_from),
      to_(options.vcd_to),
      tick_ps_(engine.tick_ps_),
      writer_(options.vcd_file, vcd_window(options, engine.tick_ps_)) {
  add_processor();
  owner_ = writer_.add("bus", "owner", 2);
  bus_address_ = writer_.add("bus", "address", 24);
  bus_data_ = writer_.add("bus", "data", 32);
  bus_function_ = writer_.add("bus", "function", 4);
  grant_ = writer_.add("bus", "grant", 1);
  add_cards();
  blank_ = writer_.add("video", "vertical_blank", 1);
  field_ = writer_.add("video", "field", 1);
  line_ = writer_.add("video", "line", 16);
  request_ = writer_.add("host", "request", 1);
  ack_ = writer_.add("host", "ack", 1);
  interrupt_ = writer_.add("host", "interrupt", 1);
  writer_.start("1 ps");
}

void ClockedVcd::add_processor() {
  const auto add = [this](const std::string& name, unsigned width) {
    return writer_.add("processor", name, width);
  };
  running_ = add("running", 1);
  page_ = add("page", 4);
  pc_ = add("pc", 12);
  word_ = add("word", 64);
  flags_ = add("flags_vcnz", 4);
  for (unsigned r = 0; r < ram_.size(); ++r) ram_[r] = add(fmt::format("ram{}", r), 32);
  q_ = add("q", 32);
  f_ = add("f", 32);
  y_ = add("y", 32);
  product_ = add("product", 32);
  counter_ = add("counter", 12);
  sar_ = add("sar", 13);
  address_ = add("bus_address", 24);
  write_data_ = add("write_data", 32);
  read_data_ = add("read_data", 32);
  cause_ = add("stall_cause", 3);
}

void ClockedVcd::add_cards() {
  for (unsigned card = 0; card < engine_.spec_.memory.cards(); ++card) {
    card_busy_.push_back(writer_.add("frame_memory", fmt::format("card{}.busy_ticks", card), 8));
    card_waiting_.push_back(writer_.add("frame_memory", fmt::format("card{}.events_waiting", card), 16));
  }
}

void ClockedVcd::before(std::int64_t n) {
  writer_.at(n * tick_ps_);
  const ProcessorState& p = engine_.processor_.state();
  writer_.set(running_, p.running);
  writer_.set(page_, p.page);
  writer_.set(pc_, p.pc);
  writer_.set(word_, p.control[engine_.processor_.word_index()]);
  writer_.set(flags_, (p.z ? 1u : 0) | (p.n ? 2u : 0) | (p.c ? 4u : 0) | (p.v ? 8u : 0));
  for (unsigned r = 0; r < ram_.size(); ++r) writer_.set(ram_[r], p.ram[r]);
  writer_.set(q_, p.q);
  writer_.set(product_, p.product);
  writer_.set(counter_, p.counter);
  writer_.set(sar_, p.sar);
  writer_.set(address_, p.bus_address);
  writer_.set(write_data_, p.write_data);
  writer_.set(read_data_, p.read_data);
  writer_.set(blank_, engine_.display_.vertical_blank());
  writer_.set(field_, engine_.display_.field());
  writer_.set(line_, static_cast<std::uint64_t>(engine_.display_.line()));
  writer_.set(interrupt_, p.interrupt);
}

void ClockedVcd::after(std::int64_t n, ClockedCause cause) {
  writer_.set(cause_, static_cast<std::uint64_t>(cause));
  if (cause == ClockedCause::kBusy) {
    writer_.set(f_, engine_.processor_.effects().f);
    writer_.set(y_, engine_.processor_.effects().y);
  }
  const bool held = engine_.owner_ != ClockedEngine::Owner::Nobody;
  const ClockedEngine::Access& access =
      engine_.owner_ == ClockedEngine::Owner::Host ? engine_.host_ : engine_.own_;
  const bool granted = held && !engine_.owner_waits_ && engine_.granted_at_ == n;
  writer_.set(owner_, static_cast<std::uint64_t>(engine_.owner_));
  if (held) {
    writer_.set(bus_address_, access.address);
    writer_.set(bus_function_, access.function);
    writer_.set(bus_data_, access.write ? access.data : access.answer);
  }
  writer_.set(grant_, granted);
  for (unsigned card = 0; card < card_busy_.size(); ++card) {
    writer_.set(card_busy_[card], static_cast<std::uint64_t>(engine_.cards_.busy_ticks(card)));
    writer_.set(card_waiting_[card], engine_.cards_.waiting(card));
  }
  const ClockedEngine::Access& host = engine_.host_;
  const bool asking =
      host.phase == ClockedEngine::Phase::kAsking || host.phase == ClockedEngine::Phase::kOnBus;
  const bool host_granted = granted && engine_.owner_ == ClockedEngine::Owner::Host;
  writer_.set(request_, (asking && host.asks_at <= n) || host_granted);
  writer_.set(ack_, host_granted);
}

}  // namespace dendro::rds3000
