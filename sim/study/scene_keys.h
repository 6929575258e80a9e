#pragma once

#include "sim/config/document.h"
#include "sim/study/catalogue.h"

namespace dendro::study {

/// Checks the names of all keys of a merged scene, before any value is used. Throws UserError with file:line
/// for the first unknown one, naming the nearest known, and for a key that cannot go with the others of its
/// table. What has the wrong form is left to those who read it.
void check_keys(const config::Node& document, const Catalogue& catalogue);

}  // namespace dendro::study
