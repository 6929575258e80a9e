#pragma once

#include <stdexcept>
#include <string>

namespace dendro {

/// The user's input is wrong. `what()` is the one line that is shown: `FILE:LINE: key: message`,
/// with the parts that are known. The command prints it to stderr and exits with 2.
class UserError : public std::runtime_error {
 public:
  explicit UserError(const std::string& message) : std::runtime_error(message), message_(message) {}
  /// `line` 0 means no line is known; an empty `key` means none is involved.
  UserError(const std::string& file, int line, const std::string& key, const std::string& message);

  const std::string& file() const { return file_; }
  int line() const { return line_; }
  const std::string& key() const { return key_; }
  const std::string& message() const { return message_; }

 private:
  std::string file_;
  int line_ = 0;
  std::string key_;
  std::string message_;
};

}  // namespace dendro
