#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace dendro::base {

/// Bytes of which there are too many for this process's memory: in a file without a name in the folder for temporary files, or in memory
/// after all where that cannot be written.
class ScratchFile {
 public:
  ScratchFile() = default;
  ~ScratchFile();
  ScratchFile(ScratchFile&& other) noexcept;
  ScratchFile& operator=(ScratchFile&& other) noexcept;

  std::size_t size() const { return size_; }

  /// At most `bytes` from `at` on; returns how many there were.
  std::size_t read(std::size_t at, void* to, std::size_t bytes) const;
  /// The first `bytes`, or all if there are fewer.
  std::vector<std::uint8_t> start(std::size_t bytes) const;
  /// Makes the file longer if need be; what lies between its end and `at` becomes 0.
  void write(std::size_t at, const void* from, std::size_t bytes);
  void clear();

  /// Appends what the file at `path` holds, or writes all to a new one there. False when that cannot be done.
  bool read_from(const std::string& path);
  bool write_to(const std::string& path) const;

 private:
  void to_memory();

  int file_ = -1;
  bool in_memory_ = false;
  std::vector<std::uint8_t> bytes_;
  std::size_t size_ = 0;
};

}  // namespace dendro::base
