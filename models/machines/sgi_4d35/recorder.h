#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "models/machines/sgi_4d35/board.h"
#include "models/machines/sgi_4d35/pipeline.h"
#include "models/machines/sgi_4d35/trace_words.h"
#include "sim/trace/trace_file.h"

namespace dendro::sgi_4d35 {

/// The time of level `cycle` that also writes down what passes one boundary, between begin and end of the writer's
/// window. Outside of it the machine runs as fast as without.
class RecordedPipeline : public Pipeline {
 public:
  RecordedPipeline(const Spec& spec, const Board& board, trace::Writer& out);

  // What the core calls: as Pipeline's. read() is false for a miss.
  bool may_hurry() const { return !watching_ && Pipeline::may_hurry(); }
  bool read(std::uint32_t address);
  void write(std::uint32_t address, unsigned size);
  void read_uncached(std::uint32_t address);
  void write_uncached(std::uint32_t address);
  void isolated_read(bool cached);
  void isolated_write(std::uint32_t address, unsigned size, bool swapped);
  void part(bool same) {
    same_ = same;
    Pipeline::part(same);
  }
  std::uint64_t fetch(std::uint32_t address, std::uint64_t now, bool warm);
  std::uint64_t fetch_uncached(std::uint32_t address, std::uint64_t now);
  std::uint64_t memory(std::uint64_t now);
  void put_off();
  std::uint64_t put_off_memory(std::uint64_t now);
  void run_clock(std::uint64_t clock);
  void finish();

  /// From here on every word is careful, so that the window can open.
  void watch() { watching_ = !ended_; }
  bool watching() const { return watching_; }
  bool ended() const { return ended_; }

 private:
  /// An access of a word from its execution until it leaves MEM.
  struct Access {
    enum Kind : std::uint8_t { kNone, kLoad, kStore, kIsolatedLoad, kIsolatedStore } kind = kNone;
    std::uint32_t address = 0;  ///< of its first byte
    unsigned size = 4;
    bool partial = false, uncached = false, swapped = false, missed = false;
    std::uint32_t word = 0, mask = ~0u;  ///< of a store: what it leaves in its word
    std::vector<std::uint32_t> words = {};  ///< of a load: its word, or its block
  };
  /// A record that waits for what is not known yet.
  struct Pending {
    trace::Record record;
    bool leaves = false;                 ///< the clock in which it leaves MEM
    std::optional<std::uint64_t> store;  ///< number of its store, of which memory's clocks are to be told
  };

  bool recording() const { return begun_ && !ended_; }
  bool of_memory() const { return memory_boundary_; }
  bool in_main(std::uint32_t address) const { return board_.in_memory(address); }

  // Window.
  void look_for_begin(std::uint64_t now);
  void look_for_end(std::uint64_t now);
  void write_state(std::uint64_t now);
  void write_tags(bool instruction);
  void write_counters(std::uint64_t last);
  void end(std::uint64_t last);

  // What memory holds as the bus sees it.
  void learn(std::uint32_t address, std::uint32_t own_mask);

  void tell_words();
  std::vector<std::uint32_t> seen(std::uint32_t address, unsigned words) const;

  // Records.
  void emit_fetch(std::uint32_t address, bool cached, bool missed);
  void emit_access(const Access& access, std::uint64_t now, std::uint64_t then);
  void emit_data_read(const Access& access, std::uint64_t now);
  void emit_store(const Access& access, std::uint64_t now, std::uint64_t then);
  void emit_read(std::uint32_t address, unsigned words, bool fetch, bool cached, std::uint64_t now,
                 const std::vector<std::uint32_t>& data);
  trace::Record record_at(std::uint64_t clock, const char* op);
  void add(Pending pending);
  void flush(std::uint64_t now);
  void take_data(Access& access);

  const Board& board_;
  trace::Writer& out_;
  const bool memory_boundary_;
  bool watching_ = false, begun_ = false, ended_ = false, same_ = false;
  std::uint64_t latest_ = 0;  ///< clock of the last record
  Access access_, later_;     ///< of the word that executes; put off
  std::optional<Access> in_mem_;
  std::uint64_t asked_ = 0, goes_on_ = 0;  ///< of the access in MEM
  std::uint64_t fetched_at_ = 0, fetch_done_ = 0;
  TraceWords words_;
  std::uint32_t telling_ = 0;                ///< address of the words to be told
  std::vector<std::uint32_t> tell_;
  std::deque<Pending> pending_;
  Counters counts_;           ///< accesses and misses of the records
  r3000_bus::Counters base_;  ///< memory's before the window
};

/// run_cycle() that writes down what passes the boundary of `out`.
ProgramResult run_recorded(const Spec& spec, const ProgramImage& image, service_block::Services& services,
                           std::uint64_t limit, trace::Writer& out);

}  // namespace dendro::sgi_4d35
