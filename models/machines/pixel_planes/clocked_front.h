#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <vector>

#include "models/parts/igc/igc_isa.h"

/// FIFO, translator and controller of a clocked Pixel-Planes, one clock at a time; rules in
/// models/parts/igc/README.md.
namespace dendro::pixel_planes {

/// Command words, each with the clock in which it landed: it is there from the beginning of the next.
class ClockedFifo {
 public:
  struct Entry {
    std::uint32_t word = 0;
    std::int64_t landed = 0;
  };
  bool empty() const { return words_.empty(); }
  std::size_t size() const { return words_.size(); }
  bool has_word(std::int64_t clock) const { return !words_.empty() && words_.front().landed < clock; }
  void land(std::uint32_t word, std::int64_t clock) { words_.push_back({word, clock}); }
  std::uint32_t take() {
    const std::uint32_t word = words_.front().word;
    words_.pop_front();
    return word;
  }

 private:
  std::deque<Entry> words_;
};

/// A coefficient as a bit stream in units of 2^-fraction.
std::int64_t translate(std::uint32_t single, unsigned fraction);

class ClockedTranslator {
 public:
  explicit ClockedTranslator(int setup_clocks) : setup_clocks_(setup_clocks) {}

  void clock(std::int64_t n, ClockedFifo& fifo);
  /// The controller took the command in this clock; call behind clock().
  void taken() { state_ = State::kIdle; }

  bool idle() const { return state_ == State::kIdle; }
  bool ready() const { return state_ == State::kReady; }
  bool lacks_words() const { return state_ == State::kReading; }
  const igc::Command& command() const { return command_; }
  unsigned state_number() const { return static_cast<unsigned>(state_); }

 private:
  enum class State : std::uint8_t { kIdle, kReading, kSetUp, kReady };
  void receive(std::uint32_t word);
  void all_received();

  int setup_clocks_;
  State state_ = State::kIdle;
  int setup_left_ = 0;
  unsigned words_left_ = 0;
  std::vector<std::uint32_t> words_;
  igc::Command command_;
};

class ClockedController {
 public:
  /// What goes out in a clock.
  struct Sent {
    igc::ArrayWord word;
    bool starts_stream = false;
    bool from_store = false;  ///< not an idle word of a register write or a copy
    unsigned address = 0;     ///< of the word in the control store
  };

  /// `copy_clocks`: of a copy, all in all.
  ClockedController(int gap_clocks, int copy_clocks)
      : gap_(static_cast<unsigned>(gap_clocks)), copy_clocks_(static_cast<unsigned>(copy_clocks)) {}

  bool running() const { return running_; }
  /// When not running; send() of the same clock gives the command's first word. False: the program sends
  /// nothing.
  bool take(const igc::Command& command);
  /// Some word from `entry` on ends a program.
  bool has_end(unsigned entry) const;
  /// One clock that is not stolen, running.
  Sent send();
  /// One clock that is not stolen, in which nothing goes out.
  void pause() { last_had_tree_ = false; }
  /// Stops the program that runs.
  void abandon() { running_ = false; }

  /// Words of the control store, two halves each.
  std::uint32_t half(std::uint32_t index) const {
    return static_cast<std::uint32_t>(store_[index / 2] >> (index % 2 * 32));
  }
  void set_half(std::uint32_t index, std::uint32_t value);
  void set_register(unsigned number, unsigned value) { registers_.at(number) = static_cast<std::uint8_t>(value); }

  const igc::Command& command() const { return command_; }
  unsigned address() const { return address_; }
  unsigned turn() const { return turn_; }
  unsigned register_value(unsigned number) const { return registers_[number]; }

 private:
  igc::MicroWord at(unsigned address) const { return igc::unpack(store_[address % igc::kStoreWords]); }
  unsigned turns_of(const igc::MicroWord& word) const;
  bool settle();
  bool step(const igc::MicroWord& word);
  igc::ArrayWord resolve(const igc::MicroWord& word) const;

  unsigned gap_, copy_clocks_;
  std::array<std::uint64_t, igc::kStoreWords> store_{};
  std::array<std::uint8_t, igc::kRegisters> registers_{};
  igc::Command command_;
  bool running_ = false;
  unsigned idle_words_ = 0;  ///< still to be sent of a register write or a copy
  bool first_word_ = false, last_had_tree_ = false;
  unsigned address_ = 0;
  bool in_loop_ = false;
  unsigned loop_first_ = 0, turns_ = 0, turn_ = 0;
};

}  // namespace dendro::pixel_planes
