#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "models/machines/pixel_planes/pixel_planes_spec.h"
#include "models/parts/igc/clocked_planes.h"

namespace dendro::pixel_planes {

/// What a clock was used for; the order of the waveform.
enum class ClockedCause : std::uint8_t { kBusy, kRefresh, kVideo, kTranslator, kDrain, kIdle };

/// Refresh and video, clock by clock.
class ClockedThieves {
 public:
  explicit ClockedThieves(const Spec& spec);

  /// Who takes clock n: kRefresh, kVideo, or kBusy for nobody. One clock after another.
  ClockedCause steal(std::int64_t n);
  /// steal(n) comes next; what became due shortly before is taken into account.
  void resume(std::int64_t n);

 private:
  Spec spec_;
  std::deque<ClockedCause> due_;  ///< not yet taken
  std::int64_t next_refresh_ps_, next_video_ps_;
};

/// Everything behind the controller: the lines of the tree, the tree, and the pixels with the control words' delay. Its
/// clocks are those that are not stolen.
class ClockedArraySide {
 public:
  explicit ClockedArraySide(const Spec& spec);

  /// The word of the next clock begins a stream.
  void start(std::int64_t a, std::int64_t b, std::int64_t c) { feed_.start(a, b, c); }
  /// One clock, in which `word` goes out; nullptr: none does. True when a word that went out has taken effect in it.
  bool clock(const igc::ArrayWord* word);
  unsigned words_on_their_way() const { return words_on_their_way_; }

  igc::ClockedPlanes& planes() { return planes_; }
  const igc::TreeLines& lines() const { return lines_; }      ///< of the last clock
  const igc::ArrayWord& obeyed() const { return obeyed_; }    ///< by the pixels in it

 private:
  struct OnItsWay {
    bool word_sent = false;
    igc::ArrayWord word;
  };

  igc::TreeFeed feed_;
  igc::ClockedPlanes planes_;
  std::vector<OnItsWay> way_;  ///< control words in the delay that equals the tree's
  std::size_t way_at_ = 0;
  unsigned words_on_their_way_ = 0;
  igc::ArrayWord obeyed_;
  igc::TreeLines lines_;
};

}  // namespace dendro::pixel_planes
