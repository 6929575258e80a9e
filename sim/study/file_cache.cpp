#include "sim/study/file_cache.h"

#include <fmt/format.h>
#include <unistd.h>
#include <zstd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <vector>

#include "sim/base/check.h"

namespace dendro::study {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kPieceBytes = 1 << 20;
constexpr int kCompressionLevel = 1;  // empty samples are most of a view, whatever the level

/// The line before the compressed bytes, which end with a checksum of their own.
std::string first_line(const std::string& key) { return "dendro file 1 " + key; }

struct FreeContext {
  void operator()(ZSTD_CCtx* context) const { ZSTD_freeCCtx(context); }
  void operator()(ZSTD_DCtx* context) const { ZSTD_freeDCtx(context); }
};

void compress(const base::ScratchFile& file, std::ofstream& to) {
  const std::unique_ptr<ZSTD_CCtx, FreeContext> context(ZSTD_createCCtx());
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_compressionLevel, kCompressionLevel);
  ZSTD_CCtx_setParameter(context.get(), ZSTD_c_checksumFlag, 1);
  std::vector<char> piece(kPieceBytes), packed(ZSTD_CStreamOutSize());
  for (std::size_t at = 0; to;) {
    const std::size_t count = file.read(at, piece.data(), kPieceBytes);
    at += count;
    const bool last = at == file.size();
    ZSTD_inBuffer in{piece.data(), count, 0};
    for (bool done = false; !done;) {
      ZSTD_outBuffer out{packed.data(), packed.size(), 0};
      const std::size_t left = ZSTD_compressStream2(context.get(), &out, &in, last ? ZSTD_e_end : ZSTD_e_continue);
      DENDRO_CHECK(!ZSTD_isError(left), "zstd: {}", ZSTD_getErrorName(left));
      to.write(packed.data(), static_cast<std::streamsize>(out.pos));
      done = last ? left == 0 : in.pos == in.size;
    }
    if (last) return;
  }
}

/// False when the bytes are not one whole frame.
bool decompress(std::ifstream& from, base::ScratchFile& file) {
  const std::unique_ptr<ZSTD_DCtx, FreeContext> context(ZSTD_createDCtx());
  std::vector<char> packed(kPieceBytes), piece(ZSTD_DStreamOutSize());
  std::size_t left = 1;
  while (from.read(packed.data(), kPieceBytes) || from.gcount() > 0) {
    ZSTD_inBuffer in{packed.data(), static_cast<std::size_t>(from.gcount()), 0};
    for (bool full = false; in.pos < in.size || full;) {
      ZSTD_outBuffer out{piece.data(), piece.size(), 0};
      left = ZSTD_decompressStream(context.get(), &out, &in);
      if (ZSTD_isError(left)) return false;
      file.write(file.size(), piece.data(), out.pos);
      if (left == 0) return in.pos == in.size && from.peek() == std::ifstream::traits_type::eof();
      full = out.pos == out.size;
    }
  }
  return false;
}

}  // namespace

std::string cache_root() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg && *xdg == '/') return std::string(xdg) + "/dendro";
  if (const char* home = std::getenv("HOME"); home && *home == '/') return std::string(home) + "/.cache/dendro";
  return "";
}

FileCache::FileCache(std::uintmax_t most_bytes) : folder_(cache_root()), most_bytes_(most_bytes) {
  if (folder_.empty()) return;
  folder_ += "/files";
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error || ::access(folder_.c_str(), W_OK) != 0) folder_.clear();
}

bool FileCache::find(const std::string& key, base::ScratchFile& file) const {
  file.clear();
  if (folder_.empty()) return false;
  const std::string path = folder_ + "/" + key;
  std::ifstream in(path, std::ios::binary);
  std::string line;
  if (!std::getline(in, line) || line != first_line(key) || !decompress(in, file)) {
    file.clear();
    return false;
  }
  std::error_code ignored;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
  return true;
}

void FileCache::store(const std::string& key, const base::ScratchFile& file) const {
  if (folder_.empty()) return;
  const std::string path = folder_ + "/" + key, work = fmt::format("{}.partial-{}", path, ::getpid());
  std::ofstream out(work, std::ios::binary | std::ios::trunc);
  out << first_line(key) << '\n';
  compress(file, out);
  out.close();
  std::error_code ignored;
  if (out)
    fs::rename(work, path, ignored);
  else
    fs::remove(work, ignored);
  make_room();
}

void FileCache::make_room() const {
  struct Entry {
    fs::file_time_type used;
    fs::path path;
    std::uintmax_t bytes;
  };
  std::vector<Entry> entries;
  std::uintmax_t sum = 0;
  std::error_code error;
  for (const auto& file : fs::directory_iterator(folder_, error)) {
    Entry entry{file.last_write_time(error), file.path(), 0};
    if (!error) entry.bytes = file.file_size(error);
    if (error) continue;  // another process was faster
    sum += entry.bytes;
    entries.push_back(std::move(entry));
  }
  std::sort(entries.begin(), entries.end(), [](const Entry& a, const Entry& b) { return a.used < b.used; });
  for (const Entry& entry : entries) {
    if (sum <= most_bytes_) return;
    fs::remove(entry.path, error);
    sum -= entry.bytes;
  }
}

}  // namespace dendro::study
