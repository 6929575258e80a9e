#include "models/machines/rds3000/recorder.h"

#include <string>

#include "models/machines/rds3000/boundaries.h"
#include "models/parts/bps32/bps32_isa.h"
#include "sim/trace/digest.h"

namespace dendro::rds3000 {
namespace {

using trace::decimal;
using trace::hex;
using trace::Record;
using trace::When;

// One record for each run of equal words that are not zero.
template <class Word>
void write_words(trace::Writer& out, const char* op, const std::vector<Word>& words, std::int64_t tick) {
  for (std::size_t i = 0, end; i < words.size(); i = end) {
    for (end = i + 1; end < words.size() && words[end] == words[i]; ++end) {
    }
    if (words[i] == 0) continue;
    Record record;
    record.at = When::at(tick);
    record.op = op;
    record.values = {hex(i), hex(words[i])};
    if (end - i > 1) record.keys.emplace_back("count", decimal(static_cast<std::int64_t>(end - i)));
    out.add(record);
  }
}

Record access_record(const SeenAccess& access, std::int64_t at) {
  Record record;
  record.at = When::at(at);
  record.op = access.write ? "write" : "read";
  record.values = {hex(access.address & kAddressMask)};
  record.keys = {{"fn", decimal(access.function)}};
  return record;
}

/// rds3000.frame_memory: image memory accesses of both masters, and what moves the display's fetches.
class MemoryRecorder : public Recorder {
 public:
  using Recorder::Recorder;

  void processor_access(const SeenAccess& access) override { memory_access(access); }
  void host_access(const SeenAccess& access) override { memory_access(access); }
  void display_register(unsigned index, std::int64_t tick) override {
    if (active()) display(index, tick);
  }

 protected:
  void write_state(std::int64_t tick) override {
    if (tick == 0) return;
    const dr64::Timing::Standing standing = engine_.timing.standing(tick);
    for (unsigned i = 0; i < 8; ++i) set(tick, "set_display", {decimal(i), hex(engine_.devices.video.fbc[i])});
    set(tick, "set_events", {},
        {{"refresh_ps", decimal(standing.next_refresh_ps)}, {"fetch_ps", decimal(standing.next_fetch_ps)},
         {"origin_ps", decimal(engine_.raster.origin_ps)}});
    for (unsigned card = 0; card < engine_.spec.memory.cards(); ++card)
      set(tick, "set_card", {decimal(card)}, {{"free", decimal(standing.free_at[card])}});
    write_words(out_, "set_pixel", engine_.devices.memory.state().pixels, tick);
    const dr64::State& memory = engine_.devices.memory.state();
    set(tick, "set_mask", {decimal(bps32::kFnMaskWord), hex(memory.mask_word)});
    set(tick, "set_mask", {decimal(bps32::kFnMaskLores), hex(memory.mask_lores)});
    set(tick, "set_mask", {decimal(bps32::kFnMaskHires), hex(memory.mask_hires)});
  }
  void write_end(std::int64_t tick) override {
    Record record;
    record.at = When::at(tick);
    record.op = "contents";
    record.answer_keys = {{"digest", hex(trace::digest(engine_.devices.memory.state().pixels))}};
    out_.add(record);
  }

 private:
  void set(std::int64_t tick, const char* op, std::vector<trace::Number> values, trace::Keys keys = {}) {
    Record record;
    record.at = When::at(tick);
    record.op = op;
    record.values = std::move(values);
    record.keys = std::move(keys);
    out_.add(record);
  }
  void display(unsigned index, std::int64_t tick) {
    set(tick, "display", {decimal(index), hex(engine_.devices.video.fbc[index])});
  }
  void memory_access(const SeenAccess& access) {
    if (!active() || device_at(access.address) != Device::Image) return;
    Record record = access_record(access, access.asked);
    if (access.write)
      record.values.push_back(hex(access.data));
    else
      record.answer = hex(access.data);
    record.answer_at = When::after(access.done - access.asked);
    record.answer_keys = {{"wait", decimal(access.granted - access.asked)}};
    out_.add(record);
  }
};

/// rds3000.processor: its bus accesses, the host's to its board, run, reset and halt, and the display's blanking.
class ProcessorRecorder : public Recorder {
 public:
  using Recorder::Recorder;

  void processor_access(const SeenAccess& access) override {
    if (!access.write) read_done_ = access.done;
    if (!active()) return;
    Record record = access_record(access, access.started);
    if (access.write)
      record.answer = hex(access.data);
    else
      record.values.push_back(hex(access.data));
    record.keys.emplace_back("takes", decimal(access.done - access.started));
    record.answer_at = When::at(access.started);
    out_.add(record);
  }
  void host_access(const SeenAccess& access) override {
    if (!active() || !on_processor_board(access.address)) return;
    Record record;
    record.at = When::at(access.granted);
    record.op = access.write ? "host_write" : "host_read";
    record.values = {hex(access.address & kAddressMask)};
    if (access.write)
      record.values.push_back(hex(access.data));
    else
      record.answer = hex(access.data);
    out_.add(record);
  }
  void raster_changed(std::int64_t tick) override {
    if (active()) blanking(tick);
  }
  void command(std::int64_t tick, bool run, bool reset) override {
    if (!active()) return;
    Record record;
    record.at = When::at(tick);
    record.op = reset ? "reset" : run ? "run" : "stop";
    out_.add(record);
  }
  void halted(std::int64_t tick) override {
    if (!active()) return;
    Record record;
    record.at = When::after(0);
    record.op = "halted";
    record.answer_at = When::at(tick);
    out_.add(record);
    registers(tick);
  }

 protected:
  void write_state(std::int64_t tick) override {
    if (tick == 0) return;
    Record record;
    record.at = When::at(tick);
    record.op = "set";
    for_each_register(engine_.processor, [&](const char* name, const auto& value) {
      if (value != 0) record.keys.emplace_back(name, hex(value));
    });
    if (!record.keys.empty()) out_.add(record);
    write_words(out_, "set_control", engine_.processor.control, tick);
    write_words(out_, "set_scratch", engine_.processor.scratch, tick);
    blanking(tick - 1);
  }
  void write_end(std::int64_t tick) override { registers(tick); }

 private:
  void blanking(std::int64_t tick) {
    const video::Raster& raster = engine_.raster.raster;
    Record record;
    record.at = When::at(tick);
    record.op = "display";
    record.keys = {{"origin_ps", decimal(engine_.raster.origin_ps)},
                   {"line_ps", decimal(raster.line_ps)},
                   {"field_lines", decimal(raster.field_lines)},
                   {"blank_lines", decimal(raster.blank_lines)}};
    out_.add(record);
  }
  void registers(std::int64_t tick) {
    Record record;
    record.at = When::at(tick);
    record.op = "registers";
    // While a read is under way its word is on the bus and nowhere else.
    const bool reading = tick <= read_done_;
    for_each_register(engine_.processor, [&](const char* name, const auto& value) {
      if (!reading || static_cast<const void*>(&value) != &engine_.processor.read_data)
        record.answer_keys.emplace_back(name, hex(value));
    });
    record.answer_keys.emplace_back("scratch", hex(trace::digest(engine_.processor.scratch)));
    out_.add(record);
  }

  std::int64_t read_done_ = 0;
};

}  // namespace

std::unique_ptr<Recorder> make_recorder(trace::Writer& out, const Watched& engine) {
  if (out.boundary() == kFrameMemoryBoundary) return std::make_unique<MemoryRecorder>(out, engine);
  if (out.boundary() == kProcessorBoundary) return std::make_unique<ProcessorRecorder>(out, engine);
  return nullptr;
}

}  // namespace dendro::rds3000
