#pragma once

#include <cstdint>
#include <deque>
#include <functional>

#include "models/machines/pixel_planes/device.h"
#include "models/machines/pixel_planes/frame_store.h"

namespace dendro::pixel_planes {

/// What all renderers of a machine have together, without time: which of them the host's words go to, the frame store, and the
/// picture.
class RendererGroup {
 public:
  /// `device(r)` is renderer r's; it must live as long as this.
  RendererGroup(const Spec& spec, std::function<Device&(std::size_t)> device);

  std::size_t count() const { return count_; }
  const Selection& selection() const { return selection_; }

  /// kSelect, and video registers, which all renderers have alike; false for other addresses.
  bool write(std::uint32_t address, std::uint32_t value);
  std::uint32_t read(std::uint32_t address) const;

  /// Renderer r has carried out a command, whose last word goes out before `clock`: a copy goes to the frame store.
  void done(std::size_t r, const igc::Command& command, std::int64_t clock);

  Picture picture() const;
  std::uint32_t peek(std::uint32_t address, unsigned low) const;

 private:
  Spec spec_;
  std::size_t count_;
  std::function<Device&(std::size_t)> device_;
  Selection selection_;
  FrameStore frame_;
};

}  // namespace dendro::pixel_planes
