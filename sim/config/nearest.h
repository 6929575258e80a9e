#pragma once

#include <string>
#include <vector>

namespace dendro::config {

/// The one of `known` with the smallest edit distance to `word` (the first of equals), or "" when `known` is
/// empty.
std::string nearest(const std::string& word, const std::vector<std::string>& known);

/// "; did you mean `x`?" for an unknown word, or "" when nothing is known.
std::string did_you_mean(const std::string& word, const std::vector<std::string>& known);

}  // namespace dendro::config
