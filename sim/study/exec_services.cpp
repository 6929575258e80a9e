#include "sim/study/exec_services.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <string>

namespace dendro::study {
namespace {

using service_block::CallResult;

/// Linux o32.
constexpr std::uint32_t kExit = 4001, kRead = 4003, kWrite = 4004, kOpen = 4005, kClose = 4006, kLseek = 4019,
                        kMarks = 0x7000, kLastMark = 0x70FF;
constexpr std::uint32_t kIoError = 5, kBadFile = 9, kFault = 14, kNoSuchCall = 89;
constexpr std::uint32_t kAppend = 0x8, kCreate = 0x100, kTruncate = 0x200, kExclusive = 0x400;
constexpr std::uint32_t kSameErrors = 34;  ///< up to here errors have the same number everywhere

CallResult failed(std::uint32_t error) { return {error, true, false}; }

CallResult outcome(long value) {
  if (value >= 0) return {static_cast<std::uint32_t>(value), false, false};
  return failed(static_cast<std::uint32_t>(errno) <= kSameErrors ? static_cast<std::uint32_t>(errno)
                                                                 : kIoError);
}

}  // namespace

HostServices::~HostServices() {
  for (const auto& [file, host] : files_) ::close(host);
}

int HostServices::host_file(std::uint32_t file) const {
  if (file <= 2) return static_cast<int>(file);
  const auto found = files_.find(file);
  return found == files_.end() ? -1 : found->second;
}

CallResult HostServices::open_file(const std::array<std::uint32_t, 4>& a,
                                   const std::vector<std::uint8_t>& memory) {
  if (a[0] >= memory.size()) return failed(kFault);
  const auto begin = memory.begin() + a[0], end = std::find(begin, memory.end(), 0);
  const std::string path(begin, end);
  int flags = static_cast<int>(a[1] & 3) | O_CLOEXEC;
  if (a[1] & kAppend) flags |= O_APPEND;
  if (a[1] & kCreate) flags |= O_CREAT;
  if (a[1] & kTruncate) flags |= O_TRUNC;
  if (a[1] & kExclusive) flags |= O_EXCL;
  const int host = ::open(path.c_str(), flags, a[2] & 0777);
  if (host < 0) return outcome(-1);
  std::uint32_t file = 3;
  while (files_.count(file)) ++file;
  files_[file] = host;
  return {file, false, false};
}

CallResult HostServices::transfer(bool in, const std::array<std::uint32_t, 4>& a,
                                  std::vector<std::uint8_t>& memory) {
  const int host = host_file(a[0]);
  if (host < 0) return failed(kBadFile);
  if (a[1] > memory.size() || a[2] > memory.size() - a[1]) return failed(kFault);
  if (!in && host == 1) std::fflush(stdout);
  long done = 0;
  do done = in ? ::read(host, memory.data() + a[1], a[2]) : ::write(host, memory.data() + a[1], a[2]);
  while (done < 0 && errno == EINTR);
  return outcome(done);
}

CallResult HostServices::call(std::uint32_t number, const std::array<std::uint32_t, 4>& a,
                              std::vector<std::uint8_t>& memory) {
  switch (number) {
    case kExit:
      exit_code = static_cast<int>(a[0] & 0xFF);
      return {0, false, true};
    case DENDRO_CALL_FAULT:
      fault = Fault{a[0], a[1], a[2], a[3]};
      return {0, false, true};
    case kRead:
      return transfer(true, a, memory);
    case kWrite:
      return transfer(false, a, memory);
    case kOpen:
      return open_file(a, memory);
    case kClose: {
      const auto file = files_.find(a[0]);
      if (file == files_.end()) return a[0] <= 2 ? CallResult{} : failed(kBadFile);
      const int host = file->second;
      files_.erase(file);
      return outcome(::close(host));
    }
    case kLseek: {
      const int host = host_file(a[0]);
      if (host < 0) return failed(kBadFile);
      return outcome(::lseek(host, static_cast<std::int32_t>(a[1]), static_cast<int>(a[2])));
    }
    default:
      return number >= kMarks && number <= kLastMark ? CallResult{} : failed(kNoSuchCall);
  }
}

}  // namespace dendro::study
