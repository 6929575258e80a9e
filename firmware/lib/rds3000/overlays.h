#pragma once

#include <cstdint>
#include <vector>

#include "firmware/lib/rds3000/rds_driver.h"

namespace dendro::lib {

/// Programs that take turns in the control store: one page of 4,096 words holds one, assembled at origin 0
/// [FG86 6.2: the programs do not fit together and are loaded one after another].  ASSUMED DEV-057
class Overlays {
 public:
  /// `control_store_words`: a multiple of 4,096; a store of more than eight pages shows eight of them.
  Overlays(RdsDriver& driver, std::uint32_t control_store_words);

  /// Makes the program ready to start and returns its entry point. It is loaded unless it is still in a page:
  /// into a free one, else into that of the program that has not been wanted for the longest time. The
  /// scratchpad gets the program's initial words each time, for all programs share it. `image` must outlive
  /// this object.
  std::uint32_t activate(const ProgramImage& image);

  std::uint64_t loads() const { return loads_; }

 private:
  struct Page {
    const ProgramImage* image = nullptr;
    std::uint64_t wanted = 0;  ///< when last
  };

  RdsDriver& driver_;
  std::vector<Page> pages_;
  std::uint64_t clock_ = 0, loads_ = 0;
};

}  // namespace dendro::lib
