#include "sim/trace/record.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <iterator>

#include "sim/base/error.h"

namespace dendro::trace {
namespace {

const Number* find(const Keys& keys, std::string_view name) {
  for (const auto& [key, number] : keys)
    if (key == name) return &number;
  return nullptr;
}

/// The shortest text that gives the same bits again, with a point.
std::string text_of_single(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  std::string text = fmt::format("{}", value);
  if (text.find('.') == std::string::npos) text.insert(std::min(text.find('e'), text.size()), ".0");
  return text;
}

void append_number(const Number& number, std::string& text) {
  if (number.single)
    text += text_of_single(static_cast<std::uint32_t>(number.value));
  else if (number.hex)
    fmt::format_to(std::back_inserter(text), "0x{:x}", number.value);
  else
    fmt::format_to(std::back_inserter(text), "{}", static_cast<std::int64_t>(number.value));
}

void append_when(const When& when, std::string& text) {
  if (when.given())
    fmt::format_to(std::back_inserter(text), "{}{}", when.kind == When::Kind::kAbsolute ? '@' : '+', when.ticks);
}

void append_keys(const Keys& keys, std::string& text) {
  for (const auto& [key, number] : keys) {
    text += ' ';
    text += key;
    text += '=';
    append_number(number, text);
  }
}

bool is_space(char c) { return c == ' ' || c == '\t' || c == '\r'; }

/// The words of one line, with the place to blame for them.
class Words {
 public:
  Words(std::string_view text, const std::string& file, int line) : text_(text), file_(file), line_(line) {
    text_ = text_.substr(0, text_.find('#'));
    skip();
  }

  bool empty() const { return text_.empty(); }
  std::string_view peek() const {
    std::size_t length = 0;
    while (length < text_.size() && !is_space(text_[length])) ++length;
    return text_.substr(0, length);
  }
  std::string_view take() {
    const std::string_view word = peek();
    text_.remove_prefix(word.size());
    skip();
    return word;
  }

  [[noreturn]] void fail(const std::string& message) const { throw UserError(file_, line_, "", message); }

  Number number(std::string_view text) const {
    const std::string_view whole = text;
    if (text.find('.') != std::string_view::npos) return single_of(text);
    const bool negative = !text.empty() && text[0] == '-';
    if (negative) text.remove_prefix(1);
    Number number;
    number.hex = text.size() > 2 && text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    if (number.hex) text.remove_prefix(2);
    const auto [end, error] =
        std::from_chars(text.data(), text.data() + text.size(), number.value, number.hex ? 16 : 10);
    const bool fits = !negative && number.hex ? true : number.value <= static_cast<std::uint64_t>(INT64_MAX);
    if (text.empty() || error != std::errc() || end != text.data() + text.size() || !fits || (negative && number.hex))
      fail(fmt::format("`{}` is not a number: decimal, or hexadecimal with 0x, of at most 64 bits", whole));
    if (negative) number.value = 0 - number.value;
    return number;
  }

  Number single_of(std::string_view text) const {
    float value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value))
      fail(fmt::format("`{}` is no number of single precision", text));
    std::uint32_t bits = 0;
    std::memcpy(&bits, &value, sizeof bits);
    return {bits, false, true};
  }

  When when(std::string_view word) const {
    const Number ticks = number(word.substr(1));
    if (ticks.single || static_cast<std::int64_t>(ticks.value) < 0 || static_cast<std::int64_t>(ticks.value) > INT64_MAX / 8)
      fail(fmt::format("`{}` is no time: ticks are 0 or more", word));
    return {word[0] == '@' ? When::Kind::kAbsolute : When::Kind::kRelative, static_cast<std::int64_t>(ticks.value)};
  }

  void key(std::string_view word, Keys& keys) const {
    const std::size_t equals = word.find('=');
    if (find(keys, word.substr(0, equals))) fail(fmt::format("`{}` stands there twice", word.substr(0, equals)));
    keys.emplace_back(std::string(word.substr(0, equals)), number(word.substr(equals + 1)));
  }

 private:
  void skip() {
    while (!text_.empty() && is_space(text_.front())) text_.remove_prefix(1);
  }

  std::string_view text_;
  const std::string& file_;
  int line_;
};

bool is_when(std::string_view word) { return !word.empty() && (word[0] == '@' || word[0] == '+'); }
bool is_key(std::string_view word) { return word.find('=') != std::string_view::npos; }

void parse_answer(Words& words, Record& record) {
  if (is_when(words.peek())) record.answer_at = words.when(words.take());
  if (!words.empty() && !is_key(words.peek())) record.answer = words.number(words.take());
  while (!words.empty()) {
    if (!is_key(words.peek())) words.fail(fmt::format("`{}` is not key=value", words.peek()));
    words.key(words.take(), record.answer_keys);
  }
  if (!record.answer_at.given() && !record.answer && record.answer_keys.empty())
    words.fail("nothing stands after ->");
}

}  // namespace

Number single(std::uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof value);
  return std::isfinite(value) ? Number{bits, false, true} : hex(bits);
}

std::int64_t Record::key(std::string_view name, std::int64_t otherwise) const {
  const Number* number = find(keys, name);
  return number ? static_cast<std::int64_t>(number->value) : otherwise;
}

bool Record::has(std::string_view name) const { return find(keys, name) != nullptr; }

std::optional<std::int64_t> Record::expected(std::string_view name) const {
  const Number* number = find(answer_keys, name);
  if (!number) return std::nullopt;
  return static_cast<std::int64_t>(number->value);
}

void append_text(const Record& record, std::string& text) {
  append_when(record.at, text);
  text += ' ';
  text += record.op;
  for (const Number& number : record.values) {
    text += ' ';
    append_number(number, text);
  }
  append_keys(record.keys, text);
  if (!record.answer_at.given() && !record.answer && record.answer_keys.empty()) return;
  text += " ->";
  if (record.answer_at.given()) {
    text += ' ';
    append_when(record.answer_at, text);
  }
  if (record.answer) {
    text += ' ';
    append_number(*record.answer, text);
  }
  append_keys(record.answer_keys, text);
}

std::string to_text(const Record& record) {
  std::string text;
  append_text(record, text);
  return text;
}

bool parse_record(std::string_view text, const std::string& file, int line, Record& record) {
  Words words(text, file, line);
  if (words.empty()) return false;
  record.line = line;
  record.values.clear();
  record.keys.clear();
  record.answer_at = {};
  record.answer.reset();
  record.answer_keys.clear();
  if (!is_when(words.peek()))
    words.fail(fmt::format("a record begins with its time, @T or +T, not with `{}`", words.peek()));
  record.at = words.when(words.take());
  if (words.empty()) words.fail("the operation is missing");
  record.op = std::string(words.take());
  while (!words.empty()) {
    const std::string_view word = words.take();
    if (word == "->") {
      parse_answer(words, record);
      break;
    }
    if (is_key(word)) {
      words.key(word, record.keys);
    } else if (!record.keys.empty()) {
      words.fail(fmt::format("`{}` is not key=value", word));
    } else {
      record.values.push_back(words.number(word));
    }
  }
  return true;
}

}  // namespace dendro::trace
