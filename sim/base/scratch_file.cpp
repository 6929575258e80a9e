#include "sim/base/scratch_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <utility>

#include "sim/base/check.h"

namespace dendro::base {
namespace {

constexpr std::size_t kPieceBytes = 1 << 20;

int temporary_file() {
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? -1 : ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
}

bool write_all(int file, std::size_t at, const char* from, std::size_t bytes) {
  while (bytes > 0) {
    const ssize_t n = ::pwrite(file, from, bytes, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n), from += n, bytes -= static_cast<std::size_t>(n);
  }
  return true;
}

}  // namespace

ScratchFile::~ScratchFile() {
  if (file_ >= 0) ::close(file_);
}

ScratchFile::ScratchFile(ScratchFile&& other) noexcept { *this = std::move(other); }

ScratchFile& ScratchFile::operator=(ScratchFile&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(in_memory_, other.in_memory_);
  bytes_.swap(other.bytes_);
  std::swap(size_, other.size_);
  return *this;
}

std::size_t ScratchFile::read(std::size_t at, void* to, std::size_t bytes) const {
  const std::size_t count = at < size_ ? std::min(bytes, size_ - at) : 0;
  if (count == 0) return 0;
  if (in_memory_) {
    std::memcpy(to, bytes_.data() + at, count);
    return count;
  }
  for (std::size_t done = 0; done < count;) {
    const ssize_t n = ::pread(file_, static_cast<char*>(to) + done, count - done, static_cast<off_t>(at + done));
    if (n < 0 && errno == EINTR) continue;
    DENDRO_CHECK(n > 0, "{} bytes of {} at {}", done, count, at);
    done += static_cast<std::size_t>(n);
  }
  return count;
}

std::vector<std::uint8_t> ScratchFile::start(std::size_t bytes) const {
  std::vector<std::uint8_t> first(std::min(bytes, size_));
  read(0, first.data(), first.size());
  return first;
}

void ScratchFile::to_memory() {
  std::vector<std::uint8_t> all = start(size_);
  if (file_ >= 0) ::close(file_);
  file_ = -1;
  in_memory_ = true;
  bytes_ = std::move(all);
}

void ScratchFile::write(std::size_t at, const void* from, std::size_t bytes) {
  if (bytes == 0) return;
  if (!in_memory_ && file_ < 0) file_ = temporary_file();
  if (!in_memory_ && (file_ < 0 || !write_all(file_, at, static_cast<const char*>(from), bytes))) to_memory();
  size_ = std::max(size_, at + bytes);
  if (!in_memory_) return;
  bytes_.resize(size_);
  std::memcpy(bytes_.data() + at, from, bytes);
}

void ScratchFile::clear() { const ScratchFile old = std::move(*this); }

bool ScratchFile::read_from(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::vector<char> piece(kPieceBytes);
  while (file.read(piece.data(), kPieceBytes) || file.gcount() > 0)
    write(size_, piece.data(), static_cast<std::size_t>(file.gcount()));
  return file.eof();
}

bool ScratchFile::write_to(const std::string& path) const {
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  std::vector<char> piece(kPieceBytes);
  for (std::size_t at = 0, n = 0; file && (n = read(at, piece.data(), kPieceBytes)) > 0; at += n)
    file.write(piece.data(), static_cast<std::streamsize>(n));
  file.close();
  return static_cast<bool>(file);
}

}  // namespace dendro::base
