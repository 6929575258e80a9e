#include "sim/trace/trace_file.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <charconv>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/base/sha256.h"

namespace dendro::trace {
namespace {

constexpr std::string_view kMagic = "dendro-trace ";
constexpr std::string_view kDigest = "sha256 ";
constexpr std::size_t kDigestLine = 7 + 64 + 1;
constexpr std::size_t kChunk = 1 << 16;
constexpr int kCompressionLevel = 9;

bool starts_with(std::string_view text, std::string_view start) { return text.substr(0, start.size()) == start; }

std::int64_t number_of(std::string_view text) {
  std::int64_t number = -1;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() ? number : -1;
}

}  // namespace

struct Writer::Compressor {
  ZSTD_CCtx* context = ZSTD_createCCtx();
  std::string packed;

  Compressor() { ZSTD_CCtx_setParameter(context, ZSTD_c_compressionLevel, kCompressionLevel); }
  ~Compressor() { ZSTD_freeCCtx(context); }
  void put(const std::string& text, ZSTD_EndDirective end) {
    ZSTD_inBuffer in{text.data(), text.size(), 0};
    char buffer[kChunk];
    for (;;) {
      ZSTD_outBuffer out{buffer, sizeof buffer, 0};
      const std::size_t left = ZSTD_compressStream2(context, &out, &in, end);
      DENDRO_CHECK(!ZSTD_isError(left), "zstd: {}", ZSTD_getErrorName(left));
      packed.append(buffer, out.pos);
      if (end == ZSTD_e_continue ? in.pos == in.size : left == 0) return;
    }
  }
};

Writer::Writer(std::string boundary, std::int64_t from, std::int64_t to, bool as_text)
    : boundary_(std::move(boundary)), from_(from), to_(to), as_text_(as_text) {
  if (!as_text) compressor_ = std::make_unique<Compressor>();
}

Writer::~Writer() = default;

void Writer::add(const Record& record) {
  append_text(record, lines_);
  lines_ += '\n';
  ++records_;
  if (compressor_ && lines_.size() >= kChunk) {
    compressor_->put(lines_, ZSTD_e_continue);
    lines_.clear();
  }
}

std::string header_text(const Header& header) {
  std::string text = fmt::format("{}{}\nmachine {}\nboundary {}\nunit tick\n", kMagic, kFormatVersion, header.machine,
                                 header.boundary);
  if (header.clock_hz > 0) text += fmt::format("clock_hz {}\n", header.clock_hz);
  if (!header.source.empty()) text += fmt::format("source {}\n", header.source);
  if (header.from > 0) text += fmt::format("from {}\n", header.from);
  for (const HeaderSetting& p : header.parameters) text += fmt::format("parameter {} {}\n", p.key, p.text);
  for (const HeaderSetting& s : header.settings) text += fmt::format("set {} {}\n", s.key, s.text);
  return text;
}

std::string Writer::file(const Header& header) {
  // Right after the first line: what is cut after it is seen to be cut.
  std::string text = header_text(header);
  text.insert(text.find('\n') + 1, fmt::format("records {}\n", records_));
  if (compressor_) {
    compressor_->put(lines_, ZSTD_e_end);
    text += fmt::format("zstd {}\n", compressor_->packed.size());
    text += compressor_->packed;
    text += '\n';
  } else {
    text += lines_;
  }
  return text + std::string(kDigest) + base::sha256(text) + "\n";
}

struct Reader::Decompressor {
  ZSTD_DCtx* context = ZSTD_createDCtx();
  std::string lines;     ///< decompressed and not yet read, from `from` on
  std::size_t from = 0;

  ~Decompressor() { ZSTD_freeDCtx(context); }
};

Reader::Reader(std::string bytes, std::string name) : name_(std::move(name)), bytes_(std::move(bytes)) {
  read_header();
  check_envelope();
  if (packed_ >= 0) decompressor_ = std::make_unique<Decompressor>();
  rewind();
}

Reader::~Reader() = default;

void Reader::fail(int line, const std::string& message) const { throw UserError(name_, line, "", message); }

void Reader::read_header() {
  if (!starts_with(bytes_, kMagic))
    fail(0, "is no trace: it does not begin with `dendro-trace 1` (a memory trace from elsewhere needs --boundary)");
  const std::size_t first = std::min(bytes_.find('\n'), bytes_.size());
  const std::int64_t version = number_of(std::string_view(bytes_).substr(kMagic.size(), first - kMagic.size()));
  if (version < 1) fail(1, "is no trace: its first line has no version");
  if (version > kFormatVersion)
    fail(1, fmt::format("was written by a newer dendro: format {}, this one reads up to {}", version, kFormatVersion));
  std::size_t at = first == bytes_.size() ? first : first + 1;
  header_lines_ = 1;
  while (at < bytes_.size() && bytes_[at] != '@' && bytes_[at] != '+' &&
         !starts_with(std::string_view(bytes_).substr(at), kDigest)) {
    const std::size_t end = std::min(bytes_.find('\n', at), bytes_.size());
    ++header_lines_;
    const std::string_view line = std::string_view(bytes_).substr(at, end - at);
    at = std::min(end + 1, bytes_.size());
    if (!header_line(line)) break;
  }
  body_ = at;
  body_end_ = bytes_.size();
  if (header_.machine.empty()) fail(header_lines_, "is truncated or incomplete: the header names no machine");
  if (header_.boundary.empty()) fail(header_lines_, "is truncated or incomplete: the header names no boundary");
}

// Returns false after the last line of the header, where compressed records follow.
bool Reader::header_line(std::string_view line) {
  while (!line.empty() && (line.back() == '\r' || line.back() == ' ')) line.remove_suffix(1);
  if (line.empty() || line[0] == '#') return true;
  const std::size_t space = std::min(line.find(' '), line.size());
  const std::string_view key = line.substr(0, space), text = line.substr(std::min(space + 1, line.size()));
  if (text.empty()) fail(header_lines_, fmt::format("`{}` says nothing", key));
  if (key == "machine") {
    header_.machine = text;
    header_.machine_line = header_lines_;
  } else if (key == "boundary") {
    header_.boundary = text;
    header_.boundary_line = header_lines_;
  } else if (key == "source") {
    header_.source = text;
  } else if (key == "unit") {
    if (text != "tick") fail(header_lines_, fmt::format("the unit of time `{}` is not known: it is tick", text));
  } else if (key == "clock_hz") {
    const std::string copy(text);
    char* end = nullptr;
    header_.clock_hz = std::strtod(copy.c_str(), &end);
    if (*end != 0 || !(header_.clock_hz > 0)) fail(header_lines_, fmt::format("`{}` is no clock in Hz", text));
  } else if (key == "parameter" || key == "set") {
    const std::size_t gap = text.find(' ');
    if (gap == std::string_view::npos) fail(header_lines_, fmt::format("`{}` has no value", text));
    auto& list = key == "set" ? header_.settings : header_.parameters;
    list.push_back({std::string(text.substr(0, gap)), std::string(text.substr(gap + 1)), header_lines_});
  } else if (key == "from" || key == "records" || key == "zstd") {
    const std::int64_t number = number_of(text);
    if (number < 0) fail(header_lines_, fmt::format("`{}` is not a number of {}", text, key));
    (key == "from" ? header_.from : key == "records" ? records_ : packed_) = number;
    if (key == "records" && !signed_off()) fail(0, "is truncated: the checksum at its end is missing");
    return key != "zstd";
  } else {
    fail(header_lines_,
         fmt::format("`{}` is no line of a header (machine, boundary, source, unit, clock_hz, from, parameter, set) and "
                     "no record",
                     key));
  }
  return true;
}

bool Reader::signed_off() const {
  const std::string_view all = bytes_;
  return all.size() >= kDigestLine && starts_with(all.substr(all.size() - kDigestLine), kDigest) && all.back() == '\n';
}

void Reader::check_envelope() {
  const std::string_view all = bytes_;
  if (packed_ >= 0 && records_ < 0) fail(header_lines_, "is corrupt: compressed records without their number");
  if (packed_ >= 0) {
    const auto packed = static_cast<std::size_t>(packed_);
    if (packed > all.size() - body_ || all.size() - body_ - packed < 1 + kDigestLine)
      fail(0, "is truncated: its end is missing");
    body_end_ = body_ + packed;
  }
  if (!signed_off()) return;  // written by hand
  const std::size_t line = all.size() - kDigestLine;
  if (base::sha256(all.substr(0, line)) != all.substr(line + kDigest.size(), 64))
    fail(0, "is corrupt: its content does not have the checksum at its end");
  if (packed_ < 0) body_end_ = line;
}

void Reader::rewind() {
  at_ = body_;
  line_ = packed_ >= 0 ? 0 : header_lines_;
  read_ = 0;
  if (!decompressor_) return;
  ZSTD_DCtx_reset(decompressor_->context, ZSTD_reset_session_only);
  decompressor_->lines.clear();
  decompressor_->from = 0;
}

bool Reader::next_line(std::string_view& line) {
  if (!decompressor_) {
    if (at_ >= body_end_) return false;
    const std::size_t end = std::min(bytes_.find('\n', at_), body_end_);
    line = std::string_view(bytes_).substr(at_, end - at_);
    at_ = end + 1;
    return true;
  }
  Decompressor& d = *decompressor_;
  std::size_t end;
  while ((end = d.lines.find('\n', d.from)) == std::string::npos) {
    d.lines.erase(0, d.from);
    d.from = 0;
    if (at_ >= body_end_) {
      if (!d.lines.empty()) fail(0, "is corrupt: its last record has no end");
      return false;
    }
    char buffer[kChunk];
    ZSTD_inBuffer in{bytes_.data() + at_, body_end_ - at_, 0};
    ZSTD_outBuffer out{buffer, sizeof buffer, 0};
    const std::size_t left = ZSTD_decompressStream(d.context, &out, &in);
    if (ZSTD_isError(left) || (in.pos == 0 && out.pos == 0)) fail(0, "is corrupt: its records cannot be decompressed");
    at_ += in.pos;
    d.lines.append(buffer, out.pos);
    // All input may be taken in while output is still held back.
    while (at_ >= body_end_ && out.pos == sizeof buffer) {
      out.pos = 0;
      const std::size_t more = ZSTD_decompressStream(d.context, &out, &in);
      if (ZSTD_isError(more)) fail(0, "is corrupt: its records cannot be decompressed");
      d.lines.append(buffer, out.pos);
    }
  }
  line = std::string_view(d.lines).substr(d.from, end - d.from);
  d.from = end + 1;
  return true;
}

bool Reader::next(Record& record) {
  std::string_view line;
  while (next_line(line)) {
    ++line_;
    if (!parse_record(line, name_, line_, record)) continue;
    ++read_;
    check(record);
    return true;
  }
  if (records_ >= 0 && read_ != records_)
    fail(0, fmt::format("is corrupt: {} records, the header says {}", read_, records_));
  return false;
}

void Reader::check_keys(const Record& record, const Keys& keys, const std::vector<std::string>& known) const {
  for (const auto& entry : keys) {
    if (std::find(known.begin(), known.end(), entry.first) != known.end()) continue;
    std::string list;
    for (const std::string& name : known) list += (list.empty() ? "" : ", ") + name;
    throw UserError(name_, record.line, entry.first,
                    fmt::format("is no key here of `{}`: {}", record.op, list.empty() ? "there are none" : list));
  }
}

void Reader::check_singles(const Record& record, const std::vector<std::string>& allowed) const {
  const auto whole = [&](const Number& number) {
    if (number.single) fail(record.line, fmt::format("`{}` takes whole numbers here", record.op));
  };
  for (const Number& number : record.values) whole(number);
  if (record.answer) whole(*record.answer);
  for (const auto& [key, number] : record.answer_keys) whole(number);
  for (const auto& [key, number] : record.keys)
    if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) whole(number);
}

void Reader::check(const Record& record) const {
  if (!boundary_) return;
  const Op* op = boundary_->find(record.op);
  if (!op) {
    std::string list;
    for (const Op& known : boundary_->ops) list += (list.empty() ? "" : ", ") + known.name;
    fail(record.line, fmt::format("{} has no operation `{}`: {}", boundary_->name, record.op, list));
  }
  if (record.values.size() < op->least || record.values.size() > op->most)
    fail(record.line, fmt::format("`{}` takes {} value{}, not {}", record.op,
                                  op->least == op->most ? fmt::format("{}", op->most)
                                                        : fmt::format("{} to {}", op->least, op->most),
                                  op->most == 1 ? "" : "s", record.values.size()));
  check_keys(record, record.keys, op->keys);
  check_singles(record, op->singles);
  check_keys(record, record.answer_keys, op->checked_keys);
  if (record.answer_at.given() && !op->checks_time) fail(record.line, fmt::format("`{}` has no answer time", record.op));
  if (record.answer && !op->checks_data) fail(record.line, fmt::format("`{}` has no answer data", record.op));
}

}  // namespace dendro::trace
