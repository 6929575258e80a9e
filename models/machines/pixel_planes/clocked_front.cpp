#include "models/machines/pixel_planes/clocked_front.h"

#include <cmath>
#include <cstring>

#include "sim/base/check.h"

namespace dendro::pixel_planes {

using igc::LoopCount;
using igc::MicroWord;
using igc::Operand;

std::int64_t translate(std::uint32_t single, unsigned fraction) {
  float coefficient;
  std::memcpy(&coefficient, &single, sizeof coefficient);
  if (std::isnan(coefficient)) return 0;
  // Exact in double; the host rounds to nearest, ties to even, as IEEE 754 has it by default.
  const double scaled =
      std::nearbyint(std::ldexp(static_cast<double>(coefficient), static_cast<int>(fraction)));
  constexpr std::int64_t kMost = std::int64_t{1} << 62;
  if (scaled >= static_cast<double>(kMost)) return kMost;
  if (scaled <= -static_cast<double>(kMost)) return -kMost;
  return static_cast<std::int64_t>(scaled);
}

void ClockedTranslator::clock(std::int64_t n, ClockedFifo& fifo) {
  switch (state_) {
    case State::kIdle:
    case State::kReading:
      if (fifo.has_word(n)) receive(fifo.take());
      return;
    case State::kSetUp:
      if (--setup_left_ == 0) state_ = State::kReady;
      return;
    case State::kReady:
      return;
  }
}

void ClockedTranslator::receive(std::uint32_t word) {
  if (state_ == State::kIdle) {
    command_ = {};
    command_.header = igc::unpack_header(word);
    words_left_ = command_.header.words();
    words_.clear();
    state_ = State::kReading;
  }
  words_.push_back(word);
  if (--words_left_ == 0) all_received();
}

void ClockedTranslator::all_received() {
  const igc::Header& h = command_.header;
  std::size_t next = 1;
  if (h.copy) command_.tile_x = words_[1] & 0xFFFF, command_.tile_y = words_[1] >> 16;
  const bool expression = !h.register_write && !h.copy && h.expression;
  if (expression) {
    command_.a = translate(words_[next++], h.fraction);
    command_.b = translate(words_[next++], h.fraction);
    command_.c = translate(words_[next++], h.fraction);
  }
  if (!h.register_write && !h.copy && h.constant) command_.constant = words_[next++];
  if (!h.register_write && !h.copy && h.long_constant) command_.constant |= std::uint64_t{words_[next++]} << 32;
  setup_left_ = expression ? setup_clocks_ : 0;
  state_ = setup_left_ > 0 ? State::kSetUp : State::kReady;
}

void ClockedController::set_half(std::uint32_t index, std::uint32_t value) {
  std::uint64_t& word = store_[index / 2];
  const unsigned low = index % 2 * 32;
  word = (word & ~(std::uint64_t{0xFFFFFFFF} << low)) | std::uint64_t{value} << low;
}

bool ClockedController::take(const igc::Command& command) {
  DENDRO_CHECK(!running_, "the controller takes a command while it runs one");
  command_ = command;
  running_ = true;
  in_loop_ = false;
  turn_ = 0;
  first_word_ = true;
  if (command.header.register_write) {
    registers_[command.header.register_number] = static_cast<std::uint8_t>(command.header.value);
    idle_words_ = 1;
    return true;
  }
  if (command.header.copy) {
    idle_words_ = copy_clocks_;
    return true;
  }
  address_ = command.header.entry;
  running_ = settle();
  return running_;
}

bool ClockedController::has_end(unsigned entry) const {
  for (unsigned n = 0; n < igc::kStoreWords; ++n)
    if (at(entry + n).end) return true;
  return false;
}

unsigned ClockedController::turns_of(const MicroWord& word) const {
  const igc::Header& h = command_.header;
  switch (word.loop) {
    case LoopCount::kFraction:
      return h.fraction;
    case LoopCount::kGuard:
      return h.guard;
    case LoopCount::kGuardLessOne:
      return h.guard > 0 ? h.guard - 1 : 0;
    case LoopCount::kGap:
      return gap_;
    case LoopCount::kRegister:
      return registers_[word.loop_number % igc::kRegisters];
    case LoopCount::kNumber:
      return word.loop_number;
    case LoopCount::kNone:
    case LoopCount::kCount:
      break;
  }
  return 1;
}

/// Skips loops of no turn from address_ on and enters the loop that stands there. False: the program has
/// ended in one that was skipped.
bool ClockedController::settle() {
  bool skipping = false;
  for (unsigned looked = 0; looked < igc::kStoreWords; ++looked) {
    const MicroWord word = at(address_);
    if (!skipping) {
      if (word.loop == LoopCount::kNone) return true;
      turns_ = turns_of(word);
      if (turns_ > 0) {
        in_loop_ = true;
        loop_first_ = address_;
        turn_ = 0;
        return true;
      }
      skipping = true;
    }
    if (word.end) return false;
    if (word.loop_end) skipping = false;
    address_ = (address_ + 1) % igc::kStoreWords;
  }
  return false;
}

/// Goes on behind a word that was sent. False: it was the program's last.
bool ClockedController::step(const MicroWord& word) {
  if (in_loop_ && word.loop_end && turn_ + 1 < turns_) {
    ++turn_;
    address_ = loop_first_;
    return true;
  }
  const bool more_turns = in_loop_ && turn_ + 1 < turns_;
  if (word.end && !more_turns) return false;
  address_ = (address_ + 1) % igc::kStoreWords;
  if (in_loop_ && !word.loop_end) return true;
  in_loop_ = false;
  turn_ = 0;
  return settle();
}

ClockedController::Sent ClockedController::send() {
  Sent sent;
  if (idle_words_ > 0) {
    running_ = --idle_words_ > 0;
    last_had_tree_ = false;
    return sent;
  }
  const MicroWord word = at(address_);
  sent.from_store = true;
  sent.address = address_;
  sent.word = resolve(word);
  sent.starts_stream = word.tree && (first_word_ || !last_had_tree_);
  first_word_ = false;
  last_had_tree_ = word.tree;
  running_ = step(word);
  return sent;
}

igc::ArrayWord ClockedController::resolve(const MicroWord& word) const {
  const auto operand = [&](Operand o) {
    if (o != Operand::kConstant) return o;
    const unsigned bit = turn_ + word.constant_offset;
    return bit < 64 && (command_.constant >> bit & 1) != 0 ? Operand::kOne : Operand::kZero;
  };
  const auto address = [&](unsigned number, unsigned offset, bool indexed) {
    return static_cast<std::uint8_t>(registers_[number] + offset + (indexed ? turn_ : 0));
  };
  igc::ArrayWord out;
  out.function = word.function;
  out.x = operand(word.x), out.y = operand(word.y);
  out.data = word.data;
  out.source = word.source;
  out.read_a = word.read_a, out.write_a = word.write_a;
  out.read_b = word.read_b, out.write_b = word.write_b;
  out.address_a = address(word.register_a, word.offset_a, word.indexed_a);
  out.address_b = address(word.register_b, word.offset_b, word.indexed_b);
  out.tree = word.tree;
  return out;
}

}  // namespace dendro::pixel_planes
