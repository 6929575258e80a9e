#include "sim/trace/kanata.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>

#include "sim/base/check.h"
#include "sim/base/error.h"

namespace dendro::trace {

KanataWriter::KanataWriter(const std::string& path) : path_(path) {
  errno = 0;
  file_.open(path, std::ios::binary | std::ios::trunc);
  if (!file_)
    throw UserError(path, 0, "", fmt::format("cannot write the pipeline log: {}", std::strerror(errno)));
  file_ << "Kanata\t0004\n";
}

void KanataWriter::at(std::int64_t clock) {
  DENDRO_CHECK(clock >= clock_, "clock {} behind {}", clock, clock_);
  clock_ = clock;
}

/// Writes how far time has gone before the next line.
void KanataWriter::pass() {
  if (written_ == clock_) return;
  if (written_ < 0)
    file_ << "C=\t" << clock_ << '\n';
  else
    file_ << "C\t" << clock_ - written_ << '\n';
  written_ = clock_;
}

void KanataWriter::begin(std::uint64_t id, std::uint64_t number) {
  pass();
  file_ << "I\t" << id << '\t' << number << "\t0\n";
}

void KanataWriter::text(std::uint64_t id, unsigned kind, const std::string& text) {
  pass();
  file_ << "L\t" << id << '\t' << kind << '\t' << text << '\n';
}

void KanataWriter::stage(std::uint64_t id, unsigned lane, const char* name) {
  pass();
  file_ << "S\t" << id << '\t' << lane << '\t' << name << '\n';
}

void KanataWriter::end(std::uint64_t id, unsigned lane, const char* name) {
  pass();
  file_ << "E\t" << id << '\t' << lane << '\t' << name << '\n';
}

void KanataWriter::retire(std::uint64_t id, std::uint64_t order, bool flushed) {
  pass();
  file_ << "R\t" << id << '\t' << order << '\t' << (flushed ? 1 : 0) << '\n';
}

void KanataWriter::close() {
  if (!file_.is_open()) return;
  file_.close();
  if (!file_) throw UserError(path_, 0, "", "the pipeline log could not be written completely");
}

}  // namespace dendro::trace
