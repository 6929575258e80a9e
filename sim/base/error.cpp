#include "sim/base/error.h"

namespace dendro {
namespace {

std::string one_line(const std::string& file, int line, const std::string& key, const std::string& message) {
  std::string text;
  if (!file.empty()) text += file + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
  if (!key.empty()) text += key + ": ";
  return text + message;
}

}  // namespace

UserError::UserError(const std::string& file, int line, const std::string& key, const std::string& message)
    : std::runtime_error(one_line(file, line, key, message)),
      file_(file),
      line_(line),
      key_(key),
      message_(message) {}

}  // namespace dendro
