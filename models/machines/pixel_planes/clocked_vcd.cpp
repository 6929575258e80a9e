#include "models/machines/pixel_planes/clocked_vcd.h"

#include "models/machines/pixel_planes/clocked.h"

namespace dendro::pixel_planes {
ClockedVcd::ClockedVcd(ClockedEngine& engine, const MachineOptions& options)
    : engine_(engine),
      from_(options.vcd_from),
      to_(options.vcd_to),
      tick_ps_(engine.tick_ps_),
      writer_(options.vcd_file, vcd_window(options, engine.tick_ps_)) {
  fifo_words_ = writer_.add("host", "fifo_words", 21);
  host_waits_room_ = writer_.add("host", "waits_for_room", 1);
  host_waits_idle_ = writer_.add("host", "waits_for_idle", 1);
  idle_ = writer_.add("host", "machine_idle", 1);
  state_ = writer_.add("translator", "state", 2);
  header_ = writer_.add("translator", "header", 32);
  running_ = writer_.add("controller", "running", 1);
  address_ = writer_.add("controller", "address", 10);
  turn_ = writer_.add("controller", "turn", 8);
  cause_ = writer_.add("controller", "cause", 3);
  a_ = writer_.add("tree", "a", 1);
  b_ = writer_.add("tree", "b", 1);
  c_ = writer_.add("tree", "c", 1);
  clear_ = writer_.add("tree", "clear", 1);
  function_ = writer_.add("array", "function", 4);
  x_ = writer_.add("array", "x", 3);
  y_ = writer_.add("array", "y", 3);
  data_ = writer_.add("array", "data", 3);
  source_ = writer_.add("array", "source", 3);
  ports_ = writer_.add("array", "read_a_write_a_read_b_write_b", 4);
  address_a_ = writer_.add("array", "address_a", 8);
  address_b_ = writer_.add("array", "address_b", 8);
  uses_tree_ = writer_.add("array", "tree", 1);
  enabled_ = writer_.add("array", "enabled_pixels", 21);
  writer_.start("1 ps");
}

void ClockedVcd::before(std::int64_t n) {
  ClockedRenderer& renderer = engine_.renderers_.front();
  writer_.at(n * tick_ps_);
  writer_.set(fifo_words_, renderer.fifo_before());
  writer_.set(host_waits_room_, engine_.host_waits_for_room_ == &renderer);
  writer_.set(host_waits_idle_, engine_.host_waits_for_idle_);
  writer_.set(idle_, renderer.was_idle());
  writer_.set(state_, renderer.translator().state_number());
  writer_.set(header_, igc::pack(renderer.translator().command().header));
  writer_.set(running_, renderer.controller().running());
  writer_.set(address_, renderer.controller().address());
  writer_.set(turn_, renderer.controller().turn());
  writer_.set(enabled_, renderer.array().planes().enabled());
}

void ClockedVcd::after(ClockedCause cause) {
  ClockedArraySide& array = engine_.renderers_.front().array();
  writer_.set(cause_, static_cast<std::uint64_t>(cause));
  writer_.set(a_, array.lines().a);
  writer_.set(b_, array.lines().b);
  writer_.set(c_, array.lines().c);
  writer_.set(clear_, array.lines().clear);
  const igc::ArrayWord& w = array.obeyed();
  writer_.set(function_, static_cast<std::uint64_t>(w.function));
  writer_.set(x_, static_cast<std::uint64_t>(w.x));
  writer_.set(y_, static_cast<std::uint64_t>(w.y));
  writer_.set(data_, static_cast<std::uint64_t>(w.data));
  writer_.set(source_, static_cast<std::uint64_t>(w.source));
  writer_.set(ports_,
              (w.read_a ? 1u : 0) | (w.write_a ? 2u : 0) | (w.read_b ? 4u : 0) | (w.write_b ? 8u : 0));
  writer_.set(address_a_, w.address_a);
  writer_.set(address_b_, w.address_b);
  writer_.set(uses_tree_, w.tree);
}

}  // namespace dendro::pixel_planes
