#pragma once

#include <string>
#include <vector>

#include "sim/config/table_reader.h"
#include "sim/scene/scene.h"

namespace dendro::study {

/// The [[object]] tables of a scene. Throws UserError with file:line and key.
std::vector<scene::Object> read_objects(config::TableReader& root);

/// The algorithm's own table; `table` may be nullptr, then everything has its default.
scene::Options read_options(const std::string& name, const config::Node* table);

}  // namespace dendro::study
