#include "sim/study/gdb_server.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <utility>
#include <vector>

namespace dendro::study {
namespace {

constexpr std::size_t kPacketBytes = 0x4000;
constexpr const char *kBad = "E01", *kNoMemory = "E02", *kOver = "E03";

std::uint8_t sum_of(std::string_view text) {
  unsigned sum = 0;
  for (const char c : text) sum += static_cast<std::uint8_t>(c);
  return static_cast<std::uint8_t>(sum);
}

/// All of the text as a hexadecimal number of 32 bits, or longer with its sign extended as GDB does for MIPS.
std::optional<std::uint32_t> number(std::string_view text) {
  std::uint64_t value = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (error != std::errc() || stop != text.data() + text.size()) return std::nullopt;
  if (value >> 32 != 0 && value >> 32 != 0xFFFFFFFF) return std::nullopt;
  return static_cast<std::uint32_t>(value);
}

std::optional<std::vector<std::uint8_t>> bytes_of(std::string_view hex) {
  std::vector<std::uint8_t> bytes;
  if (hex.size() % 2 != 0) return std::nullopt;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    const auto byte = number(hex.substr(i, 2));
    if (!byte) return std::nullopt;
    bytes.push_back(static_cast<std::uint8_t>(*byte));
  }
  return bytes;
}

/// "A,B" as two numbers.
std::optional<std::pair<std::uint32_t, std::uint32_t>> pair_of(std::string_view text) {
  const auto comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto a = number(text.substr(0, comma)), b = number(text.substr(comma + 1));
  if (!a || !b) return std::nullopt;
  return std::pair(*a, *b);
}

bool begins(std::string_view text, std::string_view with) { return text.substr(0, with.size()) == with; }

}  // namespace

GdbSession::GdbSession(Debuggee& program, std::function<bool()> interrupted,
                       std::function<std::optional<int>()> exit_code)
    : program_(program), interrupted_(std::move(interrupted)), exit_code_(std::move(exit_code)) {}

std::string GdbSession::packet(std::string_view text) {
  return fmt::format("${}#{:02x}", text, sum_of(text));
}

std::string GdbSession::receive(std::string_view bytes) {
  std::string sent;
  pending_ += bytes;
  while (!ending_) {
    const auto begin = pending_.find('$');  // before it: acknowledgements, interrupts of a program that stands
    pending_.erase(0, begin);
    const auto end = pending_.find('#');
    if (begin == std::string::npos || end == std::string::npos || end + 3 > pending_.size()) break;
    const std::string text = pending_.substr(1, end - 1);
    const auto sum = number(std::string_view(pending_).substr(end + 1, 2));
    pending_.erase(0, end + 3);
    if (sum != sum_of(text)) {
      if (acknowledges_) sent += '-';
      continue;
    }
    if (acknowledges_) sent += '+';
    if (const auto reply = answer(text)) sent += packet(*reply);
  }
  return sent;
}

std::optional<std::string> GdbSession::answer(const std::string& command) {
  const std::string_view rest = std::string_view(command).substr(command.empty() ? 0 : 1);
  switch (command.empty() ? '\0' : command[0]) {
    case '?':
      return stop_reply();
    case 'g':
      return all_registers();
    case 'G':
      return write_registers(rest);
    case 'p':
      return one_register(rest);
    case 'P':
      return write_register(rest);
    case 'm':
      return read_memory(rest);
    case 'M':
      return write_memory(rest);
    case 'Z':
    case 'z':
      return breakpoint(rest, command[0] == 'Z');
    case 'c':
    case 's':
      return resume(command[0] == 's', rest);
    case 'H':  // which thread; there is one
      return "OK";
    case 'k':
      ending_ = Ending::kKilled;
      return std::nullopt;
    case 'D':
      ending_ = Ending::kDetached;
      return "OK";
    default:
      break;
  }
  if (command == "vCont?") return "vCont;c;C;s;S";
  if (begins(command, "vCont;")) {
    const char action = command.size() > 6 ? command[6] : ' ';
    if (std::string_view("cCsS").find(action) == std::string_view::npos) return kBad;
    return resume(action == 's' || action == 'S', "");
  }
  if (command == "QStartNoAckMode") {
    acknowledges_ = false;
    return "OK";
  }
  return query(command);
}

std::string GdbSession::query(const std::string& command) const {
  const std::string description = "qXfer:features:read:target.xml:";
  if (begins(command, "qSupported"))
    return fmt::format("PacketSize={:x};qXfer:features:read+;QStartNoAckMode+;vContSupported+", kPacketBytes);
  if (command == "qAttached") return "0";
  if (!begins(command, description)) return "";
  const auto window = pair_of(std::string_view(command).substr(description.size()));
  if (!window) return kBad;
  const std::string& text = program_.description();
  const std::size_t from = std::min<std::size_t>(window->first, text.size());
  const std::string piece = text.substr(from, std::min<std::size_t>(window->second, kPacketBytes - 5));
  return (from + piece.size() < text.size() ? 'm' : 'l') + piece;
}

std::string GdbSession::all_registers() const {
  std::string text;
  for (const std::uint32_t value : program_.registers()) text += fmt::format("{:08x}", value);
  return text;
}

std::string GdbSession::one_register(std::string_view text) const {
  const auto n = number(text);
  const std::vector<std::uint32_t> values = program_.registers();
  return n && *n < values.size() ? fmt::format("{:08x}", values[*n]) : kBad;
}

/// Writes those that differ, so that one that cannot be written is no error while it stays.
std::string GdbSession::write_registers(std::string_view hex) {
  const std::vector<std::uint32_t> old = program_.registers();
  if (hex.size() != old.size() * 8 || !bytes_of(hex)) return kBad;
  for (std::size_t i = 0; i < old.size(); ++i) {
    const std::uint32_t value = *number(hex.substr(8 * i, 8));
    if (value != old[i] && !program_.set_register(i, value)) return kOver;
  }
  return "OK";
}

std::string GdbSession::write_register(std::string_view text) {
  const auto equals = text.find('=');
  if (equals == std::string_view::npos) return kBad;
  const auto n = number(text.substr(0, equals)), value = number(text.substr(equals + 1));
  if (!n || !value) return kBad;
  return program_.set_register(*n, *value) ? "OK" : kOver;
}

std::string GdbSession::read_memory(std::string_view text) const {
  const auto place = pair_of(text);
  if (!place) return kBad;
  std::vector<std::uint8_t> bytes(std::min<std::size_t>(place->second, kPacketBytes / 2 - 2));
  const std::size_t there = program_.read(place->first, bytes.data(), bytes.size());
  if (there == 0 && !bytes.empty()) return kNoMemory;
  std::string hex;
  for (std::size_t i = 0; i < there; ++i) hex += fmt::format("{:02x}", bytes[i]);
  return hex;
}

std::string GdbSession::write_memory(std::string_view text) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return kBad;
  const auto place = pair_of(text.substr(0, colon));
  const auto bytes = bytes_of(text.substr(colon + 1));
  if (!place || !bytes || bytes->size() != place->second) return kBad;
  return program_.write(place->first, bytes->data(), bytes->size()) == bytes->size() ? "OK" : kNoMemory;
}

/// "TYPE,ADDRESS,KIND". Types 0 and 1 are the same here: memory keeps the program's words.
std::string GdbSession::breakpoint(std::string_view text, bool on) {
  if (!begins(text, "0,") && !begins(text, "1,")) return "";
  const auto place = pair_of(text.substr(2));
  if (!place) return kBad;
  program_.set_breakpoint(place->first, on);
  return "OK";
}

std::string GdbSession::resume(bool step, std::string_view address) {
  if (!address.empty()) {
    const auto pc = number(address);
    if (!pc) return kBad;
    if (!program_.set_register(program_.program_counter(), *pc)) return kOver;
  }
  stop_ = step ? program_.step() : program_.run(interrupted_);
  if (stop_.ended) ending_ = Ending::kEnded;
  return stop_reply();
}

std::string GdbSession::stop_reply() const {
  if (!stop_.ended) return fmt::format("S{:02x}", stop_.signal);
  if (const auto code = exit_code_(); code && stop_.signal == 0) return fmt::format("W{:02x}", *code & 0xFF);
  return fmt::format("X{:02x}", stop_.signal);
}

}  // namespace dendro::study
