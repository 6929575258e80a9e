#pragma once

#include <string>
#include <string_view>

namespace dendro::base {

/// SHA-256 of the bytes, as 64 lower-case hex digits.
std::string sha256(std::string_view bytes);

/// SHA-256 of a file's bytes. Throws UserError when the file cannot be read.
std::string sha256_file(const std::string& path);

}  // namespace dendro::base
