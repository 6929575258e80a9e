#include "sim/trace/plain_trace.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>

#include "sim/base/error.h"

namespace dendro::trace {
namespace {

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

void skip(std::string_view& line) {
  while (!line.empty() && is_space(line.front())) line.remove_prefix(1);
}

}  // namespace

PlainReader::PlainReader(std::string bytes, std::string name) : bytes_(std::move(bytes)), name_(std::move(name)) {
  PlainReader look(*this);
  PlainAccess first;
  if (!look.next(first)) throw UserError(name_, 0, "", "has no accesses");
}

void PlainReader::fail(const std::string& message) const { throw UserError(name_, line_, "", message); }

// The next line on which something stands.
bool PlainReader::next_line(std::string_view& line) {
  while (at_ < bytes_.size()) {
    const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
    line = std::string_view(bytes_).substr(at_, end - at_);
    at_ = end + 1;
    ++line_;
    line = line.substr(0, line.find('#'));
    skip(line);
    if (!line.empty()) return true;
  }
  return false;
}

std::string_view PlainReader::word(std::string_view& line) const {
  std::size_t length = 0;
  while (length < line.size() && !is_space(line[length])) ++length;
  const std::string_view word = line.substr(0, length);
  line.remove_prefix(length);
  skip(line);
  return word;
}

PlainAccess::Kind PlainReader::kind_of(std::string_view word) const {
  if (word.size() == 1) {
    switch (word[0]) {
      case 'r':
      case 'R':
      case '0':
        return PlainAccess::kRead;
      case 'w':
      case 'W':
      case '1':
        return PlainAccess::kWrite;
      case 'i':
      case 'I':
      case '2':
        return PlainAccess::kFetch;
      default:
        break;
    }
  }
  fail(fmt::format("`{}` is no operation: r (0), w (1) or i (2)", word));
}

std::uint64_t PlainReader::number(std::string_view word, const char* what, bool always_hex) const {
  std::string_view digits = word;
  const bool hex = digits.size() > 2 && digits[0] == '0' && (digits[1] == 'x' || digits[1] == 'X');
  if (hex) digits.remove_prefix(2);
  std::uint64_t value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value, hex || always_hex ? 16 : 10);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
    fail(fmt::format("`{}` is no {}: {}", word, what,
                     always_hex ? "hexadecimal, of at most 64 bits" : "decimal, or hexadecimal with 0x, of at most 64 bits"));
  return value;
}

bool PlainReader::next(PlainAccess& access) {
  std::string_view line;
  if (!next_line(line)) return false;
  std::string_view words[4];
  unsigned count = 0;
  for (; !line.empty() && count < 4; ++count) words[count] = word(line);
  if (columns_ == 0) columns_ = count == 2 ? 2 : 3;
  if (!line.empty() || count < columns_ || (columns_ == 2 && count != 2))
    fail(columns_ == 2 ? "is not `label address`, as the lines before it" : "is not `time op address [size]`");
  access.size = 4;
  if (columns_ == 2) {
    access.kind = kind_of(words[0]);
    access.address = number(words[1], "address", true);
    time_ += access.kind == PlainAccess::kFetch;
  } else {
    const std::uint64_t time = number(words[0], "time", false);
    if (time < time_) fail(fmt::format("time goes back, from {} to {}", time_, time));
    if (time > static_cast<std::uint64_t>(INT64_MAX / 1024)) fail(fmt::format("time {} is too large", time));
    time_ = time;
    access.kind = kind_of(words[1]);
    access.address = number(words[2], "address", false);
    if (count == 4) access.size = static_cast<unsigned>(std::min<std::uint64_t>(number(words[3], "size", false), 5));
    if (access.size != 1 && access.size != 2 && access.size != 4) fail(fmt::format("`{}` is no size: 1, 2 or 4 bytes", words[3]));
  }
  access.time = time_;
  return true;
}

}  // namespace dendro::trace
