#include "sim/scene/mesh_files.h"

#include <zlib.h>

#include <algorithm>
#include <assimp/IOStream.hpp>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "sim/base/error.h"

namespace dendro::scene {
namespace {

constexpr std::size_t kLargestInflated = std::size_t{1} << 31;

bool ends_in_gz(const std::string& path) {
  return path.size() > 3 && path.compare(path.size() - 3, 3, ".gz") == 0;
}

std::string inflate_file(const std::string& path) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) throw UserError(path, 0, {}, "cannot be opened");
  gzbuffer(file.get(), 1u << 17);
  std::string bytes;
  std::string block(std::size_t{1} << 20, '\0');
  int got = 0;
  while ((got = gzread(file.get(), block.data(), static_cast<unsigned>(block.size()))) > 0) {
    bytes.append(block.data(), static_cast<std::size_t>(got));
    if (bytes.size() > kLargestInflated) throw UserError(path, 0, {}, "is larger than 2 GiB when inflated");
  }
  int error = Z_OK;
  gzerror(file.get(), &error);
  if (error == Z_BUF_ERROR) throw UserError(path, 0, {}, "is a truncated .gz file");
  if (got < 0 || error != Z_OK) throw UserError(path, 0, {}, "is a damaged .gz file");
  if (gzdirect(file.get()) != 0) throw UserError(path, 0, {}, "is not a .gz file although its name says so");
  return bytes;
}

/// A read-only stream over bytes that it owns.
class MemoryStream : public Assimp::IOStream {
 public:
  explicit MemoryStream(std::string bytes) : bytes_(std::move(bytes)) {}

  std::size_t Read(void* to, std::size_t size, std::size_t count) override {
    if (size == 0) return 0;
    const std::size_t whole = std::min(count, (bytes_.size() - at_) / size);
    std::memcpy(to, bytes_.data() + at_, whole * size);
    at_ += whole * size;
    return whole;
  }
  std::size_t Write(const void*, std::size_t, std::size_t) override { return 0; }
  aiReturn Seek(std::size_t offset, aiOrigin origin) override {
    const std::size_t base = origin == aiOrigin_SET ? 0 : origin == aiOrigin_CUR ? at_ : bytes_.size();
    // aiOrigin_END comes with a negative offset in an unsigned type, so the sum wraps as it should.
    const std::size_t target = base + offset;
    if (target > bytes_.size()) return aiReturn_FAILURE;
    at_ = target;
    return aiReturn_SUCCESS;
  }
  std::size_t Tell() const override { return at_; }
  std::size_t FileSize() const override { return bytes_.size(); }
  void Flush() override {}

 private:
  std::string bytes_;
  std::size_t at_ = 0;
};

}  // namespace

std::string read_bytes(const std::string& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw UserError(path, 0, {}, "does not exist");
  if (!std::filesystem::is_regular_file(path, ignored)) throw UserError(path, 0, {}, "is not a regular file");
  if (ends_in_gz(path)) return inflate_file(path);
  std::ifstream in(path, std::ios::binary);
  if (!in) throw UserError(path, 0, {}, "cannot be opened");
  std::string bytes((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  if (in.bad()) throw UserError(path, 0, {}, "cannot be read");
  return bytes;
}

MeshFiles::MeshFiles(std::string main_name, std::string main_bytes)
    : main_name_(std::move(main_name)), main_bytes_(std::move(main_bytes)) {}

bool MeshFiles::Exists(const char* path) const {
  std::error_code ignored;
  return main_name_ == path || std::filesystem::is_regular_file(path, ignored);
}

Assimp::IOStream* MeshFiles::Open(const char* path, const char* mode) {
  if (std::strchr(mode, 'w') != nullptr) return nullptr;
  if (main_name_ == path) return new MemoryStream(main_bytes_);
  if (!Exists(path)) return nullptr;
  std::ifstream in(path, std::ios::binary);
  if (!in) return nullptr;
  others_.insert(path);
  return new MemoryStream(
      std::string((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>()));
}

void MeshFiles::Close(Assimp::IOStream* stream) { delete stream; }

}  // namespace dendro::scene
