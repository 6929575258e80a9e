#include "sim/trace/vcd.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <numeric>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::trace {
namespace {

// Identifier codes are numbers in base 94 with the printable characters as digits.
std::string code_of(std::size_t index) {
  std::string code;
  do {
    code += static_cast<char>('!' + index % 94);
    index /= 94;
  } while (index != 0);
  return code;
}

std::vector<std::string> path_of(const std::string& unit, const std::string& name) {
  std::vector<std::string> parts{unit};
  std::size_t at = 0, dot;
  while ((dot = name.find('.', at)) != std::string::npos) {
    parts.push_back(name.substr(at, dot - at));
    at = dot + 1;
  }
  parts.push_back(name.substr(at));
  return parts;
}

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

}  // namespace

VcdWriter::VcdWriter(const std::string& path, VcdWindow window) : path_(path), window_(std::move(window)) {
  if (window_.from < 0 || window_.to <= window_.from)
    throw UserError(fmt::format(
        "waveform: the window {}..{} is empty; it must start at 0 or later and end after it starts",
        window_.from, window_.to));
  errno = 0;
  file_.open(path, std::ios::binary | std::ios::trunc);
  if (!file_)
    throw UserError(path, 0, "", fmt::format("cannot write the waveform: {}", std::strerror(errno)));
}

VcdWriter::~VcdWriter() = default;

VcdWriter::Signal VcdWriter::add(const std::string& unit, const std::string& name, unsigned width) {
  DENDRO_CHECK(!started_ && width >= 1, "{}.{} width {}", unit, name, width);
  if (!contains(seen_units_, unit)) seen_units_.push_back(unit);
  if (!window_.units.empty() && !contains(window_.units, unit)) return -1;
  const auto signal = static_cast<Signal>(signals_.size());
  signals_.push_back({unit, name, code_of(signals_.size()), width, values_.size(), false});
  values_.resize(values_.size() + (width + 63) / 64);
  return signal;
}

void VcdWriter::start(const std::string& timescale) {
  for (const std::string& unit : window_.units)
    if (!contains(seen_units_, unit)) {
      std::string known;
      for (const std::string& u : seen_units_) known += (known.empty() ? "" : ", ") + u;
      throw UserError(fmt::format("waveform: no unit \"{}\"; there are {}", unit, known));
    }
  file_ << "$version dendro $end\n$timescale " << timescale << " $end\n";
  std::vector<std::size_t> order(signals_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::vector<std::vector<std::string>> paths;
  for (const Declared& s : signals_) paths.push_back(path_of(s.unit, s.name));
  // Signals of one scope stand together; within it they keep the order in which they were declared.
  const auto scope = [&](std::size_t i) {
    return std::vector<std::string>(paths[i].begin(), paths[i].end() - 1);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return scope(a) < scope(b); });
  std::vector<std::string> open;
  for (const std::size_t i : order) {
    const std::vector<std::string> target = scope(i);
    std::size_t same = 0;
    while (same < open.size() && same < target.size() && open[same] == target[same]) ++same;
    for (; open.size() > same; open.pop_back()) file_ << "$upscope $end\n";
    for (; open.size() < target.size(); open.push_back(target[open.size()]))
      file_ << "$scope module " << target[open.size()] << " $end\n";
    const Declared& s = signals_[i];
    file_ << "$var wire " << s.width << ' ' << s.code << ' ' << paths[i].back();
    if (s.width > 1) file_ << " [" << s.width - 1 << ":0]";
    file_ << " $end\n";
  }
  for (; !open.empty(); open.pop_back()) file_ << "$upscope $end\n";
  file_ << "$enddefinitions $end\n";
  started_ = true;
}

void VcdWriter::at(std::int64_t time) {
  DENDRO_CHECK(started_ && wants(time) && time >= time_, "time {} after {}", time, time_);
  if (time != time_) time_written_ = false;
  time_ = time;
}

void VcdWriter::set(Signal signal, std::uint64_t value) {
  if (signal < 0) return;
  Declared& s = signals_[static_cast<std::size_t>(signal)];
  if (s.width < 64) value &= (std::uint64_t{1} << s.width) - 1;
  bool same = s.known && values_[s.first] == value;
  values_[s.first] = value;
  for (std::size_t word = s.first + 1; word < s.first + (s.width + 63) / 64; ++word) {
    same = same && values_[word] == 0;
    values_[word] = 0;
  }
  if (!same) emit(s);
}

void VcdWriter::set_wide(Signal signal, const std::uint64_t* words) {
  if (signal < 0) return;
  Declared& s = signals_[static_cast<std::size_t>(signal)];
  bool same = s.known;
  for (unsigned word = 0; word < (s.width + 63) / 64; ++word) {
    std::uint64_t value = words[word];
    const unsigned bits = s.width - 64 * word;
    if (bits < 64) value &= (std::uint64_t{1} << bits) - 1;
    same = same && values_[s.first + word] == value;
    values_[s.first + word] = value;
  }
  if (!same) emit(s);
}

void VcdWriter::emit(Declared& s) {
  s.known = true;
  if (!time_written_) file_ << '#' << time_ << '\n';
  time_written_ = true;
  line_.clear();
  const auto bit = [&](unsigned n) { return ((values_[s.first + n / 64] >> (n % 64)) & 1) != 0; };
  if (s.width == 1) {
    line_ += bit(0) ? '1' : '0';
  } else {
    line_ += 'b';
    unsigned top = s.width - 1;
    while (top > 0 && !bit(top)) --top;  // readers extend a short vector with zeros
    for (unsigned n = top + 1; n-- > 0;) line_ += bit(n) ? '1' : '0';
    line_ += ' ';
  }
  line_ += s.code;
  line_ += '\n';
  file_ << line_;
}

void VcdWriter::close() {
  if (!file_.is_open()) return;
  if (time_ >= 0) file_ << '#' << time_ + 1 << '\n';
  file_.close();
  if (!file_) throw UserError(path_, 0, "", "the waveform could not be written completely");
}

}  // namespace dendro::trace
