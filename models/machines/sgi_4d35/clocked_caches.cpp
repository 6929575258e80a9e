#include "models/machines/sgi_4d35/clocked_caches.h"

namespace dendro::sgi_4d35 {

ClockedCaches::ClockedCaches(const Spec& spec)
    : instruction_spec_(spec.instruction_cache),
      data_spec_(spec.data_cache),
      instruction_tags_(spec.instruction_cache),
      data_tags_(spec.data_cache),
      bus_(spec.bus) {}

void ClockedCaches::begin() {
  bus_.begin();
  if (const r3000_bus::Read* read = bus_.ended()) take_read(*read);
}

/// The last word of a read is there.
void ClockedCaches::take_read(const r3000_bus::Read& read) {
  if (!read.instruction) {
    if (read.cached) data_tags_.validate_block(read.address);
    data_.missing = false;
    data_.read_done = true;
    return;
  }
  if (!read.cached) {
    fetch_.read_done = true;
    return;
  }
  if (!instruction_spec_.streaming) instruction_tags_.validate_block(read.address);
  if (!fetch_.asked && instruction_tags_.block_of(fetch_.physical) == read.address) fetch_.missing = false;
}

void ClockedCaches::end() {
  const r3000_bus::Read* started = bus_.end();
  if (started == nullptr || !started->cached || !started->instruction) return;
  fetch_.asked = false;
  if (instruction_spec_.streaming) instruction_tags_.validate_block(started->address);
}

bool ClockedCaches::fetch(std::uint32_t physical, bool cached, bool memory) {
  fetch_ = {physical, cached, false, false, false};
  if (!cached) {
    bus_.ask({physical, 1, true, false, memory});
    return false;
  }
  ++counters_.instruction_accesses;
  fetch_.missing = !instruction_tags_.holds(physical);
  if (!fetch_.missing) return false;
  ++counters_.instruction_misses;
  fetch_.asked = true;
  bus_.ask({instruction_tags_.block_of(physical), instruction_spec_.refill_words, true, true, true});
  return true;
}

/// A block for the instruction cache comes in and is used on the way.
bool ClockedCaches::streaming() const {
  const r3000_bus::Read* read = bus_.reading();
  return instruction_spec_.streaming && read != nullptr && read->instruction && read->cached;
}

bool ClockedCaches::fetched() const {
  if (fetch_.asked) return false;
  if (streaming()) return fetch_.cached && bus_.arrives(fetch_.physical);
  return fetch_.cached ? !fetch_.missing : fetch_.read_done;
}

bool ClockedCaches::load(std::uint32_t physical, bool cached, bool memory) {
  data_ = {physical, cached, false, false, false};
  if (!cached) {
    bus_.ask({physical, 1, false, false, memory});
    return false;
  }
  data_.missing = !data_tags_.holds(physical);
  if (!data_.missing) return false;
  ++counters_.data_misses;
  bus_.ask({data_tags_.block_of(physical), data_spec_.refill_words, false, true, true});
  return true;
}

bool ClockedCaches::look_up_store(std::uint32_t physical) {
  const bool miss = !data_tags_.holds(physical);
  counters_.data_misses += miss;
  return miss;
}

void ClockedCaches::store(std::uint32_t physical, bool partial, bool cached, bool memory) {
  bus_.enter(physical, memory);
  if (!cached) return;
  if (!partial)
    data_tags_.validate(physical);
  else if (!data_spec_.store_partial)
    data_tags_.invalidate(physical);
}

void ClockedCaches::isolated_store(std::uint32_t physical, bool partial, bool swapped) {
  r3000_cache::ClockedTags& changed = tags(swapped);
  partial ? changed.invalidate(physical) : changed.validate(physical);
}

Counters ClockedCaches::counters() const {
  Counters c = counters_;
  c.memory = bus_.counters();
  return c;
}

}  // namespace dendro::sgi_4d35
