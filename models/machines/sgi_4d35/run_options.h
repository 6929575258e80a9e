#pragma once

#include <vector>

#include "models/machines/sgi_4d35/sgi_4d35.h"

namespace dendro::sgi_4d35 {

/// What a run at a level with time leaves besides its result.
struct RunOptions {
  std::vector<Retired>* retired = nullptr;   ///< every word that left MEM, killed ones among them
  r3000::State* final_state = nullptr;       ///< with the load under way finished
  MachineOptions machine;
};

}  // namespace dendro::sgi_4d35
