#include "models/machines/rds3000/clocked.h"
#include "sim/base/bits.h"
#include "sim/base/check.h"

namespace dendro::rds3000 {

void ClockedEngine::periodic_events(std::int64_t n) {
  const std::int64_t now_ps = n * tick_ps_;
  while (next_refresh_ps_ <= now_ps) {
    cards_.queue_refresh();
    next_refresh_ps_ += spec_.memory.refresh_interval_ps;
  }
  for (unsigned due = display_.step(now_ps); due > 0; --due) cards_.queue_fetch();
  cards_.serve(memory_counters_);
}

void ClockedEngine::complete_accesses(std::int64_t n) {
  if (own_.phase == Phase::kGranted && n >= own_.complete_at) {
    own_.phase = Phase::kNone;
    if (!own_.write) processor_.load_read_data(own_.answer);
  }
  if (host_.phase == Phase::kGranted && n >= host_.complete_at) host_.phase = Phase::kNone;
}

void ClockedEngine::start_access(Access& access, std::int64_t asks_at, bool write, std::uint32_t address,
                                 std::uint32_t data, unsigned function) {
  access.phase = Phase::kAsking;
  access.write = write;
  access.address = address & kAddressMask;
  access.data = data;
  access.function = function & 0xF;
  access.device = device_at(address);
  access.asks_at = asks_at;
  access.answer = 0;
}

void ClockedEngine::arbitrate(std::int64_t n) {
  if (owner_ == Owner::Nobody || (!owner_waits_ && n >= released_at_)) {
    owner_ = Owner::Nobody;
    if (own_.phase == Phase::kAsking && n >= own_.asks_at) {
      owner_ = Owner::Processor;
    } else if (host_.phase == Phase::kAsking && n >= host_.asks_at) {
      owner_ = Owner::Host;
    }
    if (owner_ == Owner::Nobody) return;
    Access& winner = owner_ == Owner::Processor ? own_ : host_;
    winner.phase = Phase::kOnBus;
    winner.got_at = n;
    winner.cards = 0;
    winner.masked = false;
    if (winner.device == Device::Image) {
      const dr64::Work work = memory_.probe(winner.address, winner.function, winner.write);
      winner.cards = work.cards;
      winner.masked = work.masked;
    }
    owner_waits_ = true;
  }
  if (!owner_waits_) return;
  Access& access = owner_ == Owner::Processor ? own_ : host_;
  if (cards_.free(access.cards)) grant(access, n);
}

void ClockedEngine::grant(Access& access, std::int64_t n) {
  const bool from_host = owner_ == Owner::Host;
  const std::int64_t hold = access.write ? spec_.bus.write_ticks : 1;
  owner_waits_ = false;
  released_at_ = n + hold;
  granted_at_ = n;
  bus_counters_.busy += static_cast<std::uint64_t>(n - access.got_at + hold);
  if (access.cards != 0) take_cards(access, n);

  access.phase = Phase::kGranted;
  if (access.write) {
    ++(from_host ? bus_counters_.host_writes : bus_counters_.processor_writes);
    access.complete_at = n + spec_.bus.write_ticks;
    write_device(access, from_host, n);
  } else {
    ++(from_host ? bus_counters_.host_reads : bus_counters_.processor_reads);
    access.complete_at = n + (access.cards != 0 ? spec_.memory.read_ticks : spec_.bus.register_read_ticks);
    access.answer = read_device(access, from_host);
  }

  if (!from_host) return;
  const bool steals = access.device == Device::ControlStore || access.device == Device::Scratchpad ||
                      access.device == Device::Processor;
  if (steals) processor_.steal(n);
  // While finishing there is no host any more to wake.
  const std::int64_t done_ps = access.complete_at * tick_ps_;
  const auto now_ps = static_cast<std::int64_t>(sc_core::sc_time_stamp().value());
  if (!finished_)
    host_done_.notify(sc_core::sc_time::from_value(static_cast<sc_dt::uint64>(done_ps - now_ps)));
}

void ClockedEngine::take_cards(const Access& access, std::int64_t n) {
  const bool masked = access.write && access.masked;
  const int ticks = spec_.memory.card_busy_ticks + (masked ? spec_.memory.masked_write_extra_ticks : 0);
  cards_.take(access.cards, ticks);
  memory_counters_.busy_access += static_cast<std::uint64_t>(ticks * __builtin_popcount(access.cards));
  memory_counters_.wait_ticks += static_cast<std::uint64_t>(n - access.got_at);
  ++(access.write ? memory_counters_.writes : memory_counters_.reads);
  if (masked) ++memory_counters_.masked_writes;
}

std::uint32_t ClockedEngine::read_device(const Access& access, bool from_host) const {
  switch (access.device) {
    case Device::Image:
      return memory_.read(access.address, access.function);
    case Device::ControlStore:
    case Device::Scratchpad:
    case Device::Processor:
      return from_host ? processor_.host_read(access.address) : 0;
    case Device::LookUpTable:
      return video_.lut[access.address - kLookUpTable];
    case Device::LuvoCrossbar:
      return video_.luvo_crossbar;
    case Device::Crossbar:
      return video_.crossbar[access.address - kCrossbar];
    default:
      return 0;  // the FBC is write only
  }
}

void ClockedEngine::write_device(const Access& access, bool from_host, std::int64_t n) {
  switch (access.device) {
    case Device::Image:
      memory_.write(access.address, access.data, access.function);
      return;
    case Device::ControlStore:
    case Device::Scratchpad:
    case Device::Processor:
      if (from_host) processor_.host_write(access.address, access.data);
      return;
    case Device::LookUpTable:
      video_.lut[access.address - kLookUpTable] = access.data & 0x3FFFFFFF;
      return;
    case Device::LuvoCrossbar:
      video_.luvo_crossbar = access.data & 0x3F;
      return;
    case Device::Crossbar:
      video_.crossbar[access.address - kCrossbar] = access.data & 0x3F;
      return;
    case Device::Fbc: {
      const std::uint32_t index = access.address - kFbc;
      video_.fbc[index] = access.data;
      if (index == 1 || index == 4 || index == 5) restart_display(n);
      return;
    }
    default:
      return;
  }
}

void ClockedEngine::restart_display(std::int64_t n) {
  const video::Raster raster = video::raster_of(video_, spec_.video, spec_.memory.fetch_bits);
  if (raster == display_.raster()) return;
  const std::int64_t now_ps = n * tick_ps_;
  display_.restart(raster, now_ps, now_ps);
  // A line without blanking has its first fetch at this very tick.
  for (unsigned due = display_.step(now_ps); due > 0; --due) cards_.queue_fetch();
  cards_.serve(memory_counters_);
}

}  // namespace dendro::rds3000
