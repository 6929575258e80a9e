#pragma once

#include <string>
#include <utility>

#include "sim/base/error.h"

namespace dendro::tools {

/// A UserError in a source text that also knows the column: `what()` is `FILE:LINE:COLUMN: message`.
class SourceError : public UserError {
 public:
  SourceError(const std::string& file, int line, int column, const std::string& message)
      : UserError(file, line, "", message),
        text_(file + ":" + std::to_string(line) + ":" + std::to_string(column) + ": " + message),
        column_(column) {}

  const char* what() const noexcept override { return text_.c_str(); }
  int column() const { return column_; }

 private:
  std::string text_;
  int column_;
};

}  // namespace dendro::tools
