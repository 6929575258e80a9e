#pragma once

#include <vector>

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// What a run at a level with time does besides counting.
struct RunOptions {
  /// Gets an entry for every word that completes, and for every one that faults or is interrupted.
  std::vector<Retired>* retired = nullptr;
  /// Gets the state behind the last word, a load under way finished.
  r3000::State* final_state = nullptr;
  MachineOptions machine;  ///< of these: waveform, pipeline log, progress
};

}  // namespace dendro::sgi_4d35
