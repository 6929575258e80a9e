#include "sim/study/exec_services.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "sim/study/worker.h"

namespace dendro::study {
namespace {

using service_block::CallResult;

/// Linux o32.
constexpr std::uint32_t kExit = 4001, kRead = 4003, kWrite = 4004, kOpen = 4005, kClose = 4006, kLseek = 4019,
                        kMarks = 0x7000, kLastMark = 0x70FF;
constexpr long kNoEntry = 2, kIoError = 5, kBadFile = 9, kFault = 14, kExists = 17, kInvalid = 22, kNoSuchCall = 89;
constexpr std::uint32_t kAppend = 0x8, kCreate = 0x100, kTruncate = 0x200, kExclusive = 0x400;
constexpr long kSameErrors = 34;  ///< up to here errors have the same number everywhere

CallResult outcome(long value) {
  if (value >= 0) return {static_cast<std::uint32_t>(value), false, false};
  return {static_cast<std::uint32_t>(-value), true, false};
}

/// Of a call of this process.
long or_error(long value) {
  if (value >= 0) return value;
  return errno <= kSameErrors ? -errno : -kIoError;
}

/// The lowest number of 3 and above that is not a key.
template <class Map>
std::uint32_t free_number(const Map& files) {
  std::uint32_t file = 3;
  while (files.count(file)) ++file;
  return file;
}

}  // namespace

CallResult CallServices::call(std::uint32_t number, const std::array<std::uint32_t, 4>& a,
                              base::ZeroedBytes& memory) {
  const bool inside = a[1] <= memory.size() && a[2] <= memory.size() - a[1];
  switch (number) {
    case kExit:
      exit_code = static_cast<int>(a[0] & 0xFF);
      return {0, false, true};
    case DENDRO_CALL_FAULT:
      fault = Fault{a[0], a[1], a[2], a[3]};
      return {0, false, true};
    case kRead: {
      CallResult result = outcome(inside ? read_file(a[0], memory.data() + a[1], a[2]) : -kFault);
      if (!result.failed) result.changed = a[1], result.changed_bytes = result.value;
      return result;
    }
    case kWrite:
      return outcome(inside ? write_file(a[0], memory.data() + a[1], a[2]) : -kFault);
    case kOpen: {
      if (a[0] >= memory.size()) return outcome(-kFault);
      const auto begin = memory.begin() + a[0];
      return outcome(open_file(std::string(begin, std::find(begin, memory.end(), 0)), a[1], a[2]));
    }
    case kClose:
      return outcome(close_file(a[0]));
    case kLseek:
      return outcome(seek_file(a[0], static_cast<std::int32_t>(a[1]), a[2]));
    default:
      if (number < kMarks || number > kLastMark) return outcome(-kNoSuchCall);
      mark(number, a[0]);
      return {};
  }
}

HostServices::~HostServices() {
  for (const auto& [file, host] : files_) ::close(host);
}

int HostServices::host_file(std::uint32_t file) const {
  if (file <= 2) return static_cast<int>(file);
  const auto found = files_.find(file);
  return found == files_.end() ? -1 : found->second;
}

long HostServices::open_file(const std::string& path, std::uint32_t wanted, std::uint32_t mode) {
  int flags = static_cast<int>(wanted & 3) | O_CLOEXEC;
  if (wanted & kAppend) flags |= O_APPEND;
  if (wanted & kCreate) flags |= O_CREAT;
  if (wanted & kTruncate) flags |= O_TRUNC;
  if (wanted & kExclusive) flags |= O_EXCL;
  const int host = ::open(path.c_str(), flags, mode & 0777);
  if (host < 0) return or_error(host);
  const std::uint32_t file = free_number(files_);
  files_[file] = host;
  return file;
}

long HostServices::close_file(std::uint32_t number) {
  const auto file = files_.find(number);
  if (file == files_.end()) return number <= 2 ? 0 : -kBadFile;
  const int host = file->second;
  files_.erase(file);
  return or_error(::close(host));
}

long HostServices::read_file(std::uint32_t file, std::uint8_t* to, std::uint32_t bytes) {
  const int host = host_file(file);
  if (host < 0) return -kBadFile;
  long done = 0;
  do {
    check_interrupt();
    done = ::read(host, to, bytes);
  } while (done < 0 && errno == EINTR);
  return or_error(done);
}

long HostServices::write_file(std::uint32_t file, const std::uint8_t* from, std::uint32_t bytes) {
  const int host = host_file(file);
  if (host < 0) return -kBadFile;
  if (host == 1 && !shows_output_) return static_cast<long>(bytes);
  if (host == 1) std::fflush(stdout);
  long done = 0;
  do {
    check_interrupt();
    done = ::write(host, from, bytes);
  } while (done < 0 && errno == EINTR);
  return or_error(done);
}

long HostServices::seek_file(std::uint32_t file, std::int32_t offset, std::uint32_t from) {
  const int host = host_file(file);
  return host < 0 ? -kBadFile : or_error(::lseek(host, offset, static_cast<int>(from)));
}

std::size_t MemoryServices::Open::read(std::uint8_t* to, std::size_t count) const {
  if (large != nullptr) return large->read(at, to, count);
  const std::size_t from = std::min(at, bytes->size()), there = std::min(count, bytes->size() - from);
  std::memcpy(to, bytes->data() + from, there);
  return there;
}

void MemoryServices::Open::write(const std::uint8_t* from, std::size_t count) {
  if (large != nullptr) return large->write(at, from, count);
  if (bytes->size() < at + count) bytes->resize(at + count);
  std::memcpy(bytes->data() + at, from, count);
}

void MemoryServices::Open::clear() {
  if (large != nullptr)
    large->clear();
  else
    bytes->clear();
}

MemoryServices::Open MemoryServices::find(const std::string& path) {
  if (large_ != nullptr)
    if (const auto found = large_->find(path); found != large_->end()) return {nullptr, &found->second, 0};
  const auto found = files_.find(path);
  return {found == files_.end() ? nullptr : &found->second, nullptr, 0};
}

long MemoryServices::open_file(const std::string& path, std::uint32_t flags, std::uint32_t) {
  Open opened = find(path);
  const bool there = opened.bytes != nullptr || opened.large != nullptr;
  if (!there && !(flags & kCreate)) return -kNoEntry;
  if (there && (flags & kCreate) && (flags & kExclusive)) return -kExists;
  if (!there) opened.bytes = &files_[path];
  if (flags & kTruncate) opened.clear();
  if (flags & kAppend) opened.at = opened.size();
  const std::uint32_t file = free_number(open_);
  open_[file] = opened;
  return file;
}

long MemoryServices::close_file(std::uint32_t file) { return open_.erase(file) != 0 || file <= 2 ? 0 : -kBadFile; }

long MemoryServices::read_file(std::uint32_t file, std::uint8_t* to, std::uint32_t bytes) {
  if (file == 0) return 0;
  const auto found = open_.find(file);
  if (found == open_.end()) return -kBadFile;
  Open& open = found->second;
  const std::size_t count = open.read(to, bytes);
  open.at += count;
  return static_cast<long>(count);
}

long MemoryServices::write_file(std::uint32_t file, const std::uint8_t* from, std::uint32_t bytes) {
  if (file == 1 || file == 2) {
    (file == 1 ? output : errors).append(reinterpret_cast<const char*>(from), bytes);
    return bytes;
  }
  const auto found = open_.find(file);
  if (found == open_.end()) return -kBadFile;
  Open& open = found->second;
  open.write(from, bytes);
  open.at += bytes;
  return bytes;
}

long MemoryServices::seek_file(std::uint32_t file, std::int32_t offset, std::uint32_t from) {
  const auto found = open_.find(file);
  if (found == open_.end() || from > 2) return found == open_.end() ? -kBadFile : -kInvalid;
  Open& open = found->second;
  const auto base = static_cast<std::int64_t>(from == 0 ? 0 : from == 1 ? open.at : open.size());
  if (base + offset < 0) return -kInvalid;
  open.at = static_cast<std::size_t>(base + offset);
  return static_cast<long>(open.at);
}

}  // namespace dendro::study
