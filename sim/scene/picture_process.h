#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "sim/scene/picture_messages.h"

namespace dendro::scene {

/// Has `libexec/dendro/dendro-pictures` do one piece of work on the picture file `path`: the program is started by the first call of a
/// process, answers until that process ends, and lies in the executable's folder or in one above it. Throws UserError with what it says
/// of the user's files, and when it is missing.
PictureMessage picture_work(const nlohmann::json& head, const std::string& path, const std::vector<Span>& spans = {});

}  // namespace dendro::scene
