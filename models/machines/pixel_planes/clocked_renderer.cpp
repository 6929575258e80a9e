#include "models/machines/pixel_planes/clocked_renderer.h"

#include <fmt/format.h>

namespace dendro::pixel_planes {
namespace {

constexpr unsigned kWordBits = 32;

}  // namespace

ClockedRenderer::ClockedRenderer(const Spec& spec)
    : spec_(spec),
      translator_(spec.setup_clocks),
      controller_(spec.tree.gap_clocks, spec.copy_words()),
      array_(spec) {}

void ClockedRenderer::begin(std::int64_t n) {
  for (; !writes_.empty() && writes_.front().clock < n; writes_.pop_front())
    controller_.set_half(writes_.front().index, writes_.front().value);
  idle_before_ = !fifo_.has_word(n) && behind_fifo_idle();
  fifo_before_ = fifo_.size() - (last_landed_ == n ? 1 : 0);
}

ClockedCause ClockedRenderer::clock(std::int64_t n, ClockedCause thief) {
  const ClockedCause cause = cause_of(n, thief);
  count(cause);
  at_work_ = controller_.running();
  copied_ = false;
  const bool ready = translator_.ready();
  translator_.clock(n, fifo_);
  if (thief == ClockedCause::kBusy) move_array(ready);
  return cause;
}

ClockedCause ClockedRenderer::cause_of(std::int64_t n, ClockedCause thief) const {
  if (controller_.running() || translator_.ready()) return thief;
  if (fifo_.has_word(n) || !translator_.idle()) return ClockedCause::kTranslator;
  return array_.words_on_their_way() > 0 ? ClockedCause::kDrain : ClockedCause::kIdle;
}

void ClockedRenderer::count(ClockedCause cause) {
  switch (cause) {
    case ClockedCause::kBusy:
      ++counters.busy;
      return;
    case ClockedCause::kRefresh:
      ++counters.stall_refresh;
      return;
    case ClockedCause::kVideo:
      ++counters.stall_video;
      return;
    case ClockedCause::kTranslator:
      ++counters.stall_translator;
      return;
    case ClockedCause::kDrain:
      ++counters.stall_drain;
      return;
    case ClockedCause::kIdle:
      ++counters.idle;
      return;
  }
}

void ClockedRenderer::take() {
  header_ = translator_.command().header;
  const bool runs_program = !header_.register_write && !header_.copy;
  if (runs_program && !controller_.has_end(header_.entry)) {
    error_ = fmt::format("the micro-program at word {} of the control store has no end", header_.entry);
  } else if (!controller_.take(translator_.command())) {
    error_ = fmt::format("the micro-program at word {} sends nothing", header_.entry);
  }
  translator_.taken();
  ++fifo_counters.commands;
  at_work_ = true;
}

void ClockedRenderer::move_array(bool ready) {
  if (!controller_.running() && ready) take();
  if (!controller_.running()) {
    controller_.pause();
    array_.clock(nullptr);
    return;
  }
  const ClockedController::Sent sent = controller_.send();
  const igc::Command& command = controller_.command();
  if (sent.starts_stream) array_.start(command.a, command.b, command.c);
  array_.clock(&sent.word);
  copied_ = command.header.copy && !controller_.running();
}

void ClockedRenderer::land(std::uint32_t word, std::int64_t n) {
  fifo_.land(word, n);
  last_landed_ = n;
}

bool ClockedRenderer::room_at(std::int64_t n, std::int64_t next) const {
  const std::size_t landed_now = last_landed_ == n ? 1 : 0;
  const std::size_t words = n == next ? fifo_.size() - landed_now : fifo_before_;
  return words < static_cast<std::size_t>(spec_.fifo_words);
}

std::uint32_t ClockedRenderer::load(std::uint32_t index) const {
  for (auto write = writes_.rbegin(); write != writes_.rend(); ++write)
    if (write->index == index) return write->value;
  return controller_.half(index);
}

bool ClockedRenderer::behind_fifo_idle() const {
  return translator_.idle() && !controller_.running() && array_.words_on_their_way() == 0;
}

bool ClockedRenderer::cannot_become_idle() const {
  return translator_.lacks_words() && fifo_.empty() && !controller_.running() && array_.words_on_their_way() == 0;
}

void ClockedFrame::copy(unsigned column, unsigned row, igc::ClockedPlanes& planes) {
  const auto width = static_cast<unsigned>(spec_.array.width), height = static_cast<unsigned>(spec_.array.height);
  if ((column + 1) * width > static_cast<unsigned>(spec_.frame.width) ||
      (row + 1) * height > static_cast<unsigned>(spec_.frame.height))
    return;
  std::vector<std::uint32_t>& words = tiles_[{column, row}];
  words.clear();
  for (unsigned y = 0; y < height; ++y)
    for (unsigned x = 0; x < width; ++x)
      for (unsigned low = 0; low < static_cast<unsigned>(spec_.array.memory_bits); low += kWordBits)
        words.push_back(planes.memory_word(low, x, y));
}

std::uint32_t ClockedFrame::peek(std::uint32_t pixel, unsigned low) const {
  const auto width = static_cast<unsigned>(spec_.frame.width);
  const auto tile_width = static_cast<unsigned>(spec_.array.width), tile_height = static_cast<unsigned>(spec_.array.height);
  if (width == 0) return 0;
  const unsigned x = pixel % width, y = pixel / width;
  const auto tile = tiles_.find({x / tile_width, y / tile_height});
  if (tile == tiles_.end()) return 0;
  const unsigned words = (static_cast<unsigned>(spec_.array.memory_bits) + kWordBits - 1) / kWordBits;
  const std::size_t first = static_cast<std::size_t>(y % tile_height * tile_width + x % tile_width) * words;
  const unsigned at = low / kWordBits;
  std::uint64_t both = at < words ? tile->second[first + at] : 0;
  if (at + 1 < words) both |= std::uint64_t{tile->second[first + at + 1]} << kWordBits;
  return static_cast<std::uint32_t>(both >> (low % kWordBits));
}

}  // namespace dendro::pixel_planes
