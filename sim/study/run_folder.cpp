#include "sim/study/run_folder.h"

#include <fmt/format.h>
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace dendro::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFull = "the disk is full or the folder is read-only";

[[noreturn]] void cannot_write(const std::string& path, const std::string& why) {
  throw UserError(path, 0, "", "cannot write here: " + why);
}

void write_file(const std::string& path, const std::string& text, const std::string& shown) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  if (!out) cannot_write(shown, kFull);
}

void rename_over(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) cannot_write(to.string(), error.message());
}

/// A full disk refuses the first block already, before long work instead of after it.
bool takes_a_block(const std::string& path) {
  std::ofstream out(path, std::ios::binary | std::ios::trunc);
  out << std::string(4096, ' ');
  out.close();
  const bool good = static_cast<bool>(out);
  std::ofstream(path, std::ios::binary | std::ios::trunc);
  return good;
}

/// The same of a device that is no terminal; what stands behind it gets an empty line.
bool takes_a_line(const std::string& path) {
  const int fd = ::open(path.c_str(), O_WRONLY | O_NOCTTY);
  if (fd < 0) return true;  // whatever it is, the write will say
  const bool good = ::isatty(fd) != 0 || ::write(fd, "\n", 1) == 1;
  ::close(fd);
  return good;
}

/// Folders that must be made for `folder` to exist, outermost first.
std::vector<std::string> missing_folders(const fs::path& folder) {
  std::vector<std::string> missing;
  std::error_code error;
  for (fs::path at = folder; !at.empty() && !fs::exists(at, error); at = at.parent_path())
    missing.insert(missing.begin(), at.string());
  return missing;
}

}  // namespace

RunFolder::RunFolder(const std::string& path) {
  scene::require_picture_files();
  std::string plain = path;
  while (plain.size() > 1 && plain.back() == '/') plain.pop_back();
  path_ = plain;
  std::error_code error;
  if (fs::exists(path_, error) && !fs::is_directory(path_, error))
    cannot_write(path_, "it is a file, not a folder");
  const fs::path absolute = fs::absolute(path_).lexically_normal();
  made_ = missing_folders(absolute.parent_path());
  fs::create_directories(absolute.parent_path(), error);
  const bool is_root = !absolute.has_filename();
  const fs::path parent = is_root ? absolute : absolute.parent_path();
  work_ = (parent / fmt::format(".{}.partial-{}", absolute.filename().string(), ::getpid())).string();
  if (!error) fs::create_directory(work_, error);
  if (!error && fs::is_directory(path_) && ::access(path_.c_str(), W_OK) != 0)
    error = std::make_error_code(std::errc::permission_denied);
  const std::string probe = work_ + "/probe";
  if (!error && !takes_a_block(probe)) error = std::make_error_code(std::errc::no_space_on_device);
  std::error_code unused;
  fs::remove(probe, unused);
  if (error) {
    const std::string why = error.message();
    std::error_code ignored;
    fs::remove_all(work_, ignored);
    for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);
    cannot_write(path_, why);
  }
}

RunFolder::~RunFolder() {
  if (committed_) return;
  std::error_code ignored;
  fs::remove_all(work_, ignored);
  for (auto made = made_.rbegin(); made != made_.rend(); ++made) fs::remove(*made, ignored);
}

void RunFolder::write(const std::string& name, const std::string& text) {
  write_file(work_ + "/" + name, text, path_ + "/" + name);
}

void RunFolder::rename(const UserError& error) const {
  if (error.file().compare(0, work_.size(), work_) != 0) throw error;
  throw UserError(path_ + error.file().substr(work_.size()), error.line(), error.key(), error.message());
}

void RunFolder::commit() {
  if (!fs::exists(path_)) {
    rename_over(work_, path_);
  } else {
    std::error_code unseen;
    for (const char* film : {"frames", "animation.gif"}) fs::remove_all(fs::path(path_) / film, unseen);  // of another run
    for (const auto& entry : fs::directory_iterator(work_)) {
      const fs::path to = fs::path(path_) / entry.path().filename();
      std::error_code ignored;
      if (entry.is_directory()) fs::remove_all(to, ignored);  // a folder does not go over one that holds something
      rename_over(entry.path(), to);
    }
    fs::remove(work_);
  }
  committed_ = true;
}

void write_picture(const std::string& path, const scene::RgbImage& image) {
  const std::string work = fmt::format("{}.partial-{}.png", path, ::getpid());
  try {
    scene::write_png(work, image);
  } catch (const UserError&) {
    cannot_write(path, kFull);
  }
  rename_over(work, path);
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  if (path_.empty() || path_ == "-") return;
  std::error_code error;
  const auto status = fs::status(path_, error);
  if (fs::is_directory(status)) cannot_write(path_, "it is a folder");
  if (fs::exists(status) && ::access(path_.c_str(), W_OK) != 0) cannot_write(path_, "permission denied");
  if (fs::is_character_file(status) && !takes_a_line(path_)) cannot_write(path_, kFull);
  if (fs::exists(status) && !fs::is_regular_file(status)) return;
  work_ = fmt::format("{}.partial-{}", path_, ::getpid());
  std::ofstream out(work_);
  if (!out) {
    work_.clear();
    cannot_write(path_, "the folder does not exist or is read-only");
  }
  out.close();
  if (takes_a_block(work_)) return;
  fs::remove(work_, error);
  cannot_write(path_, kFull);
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!work_.empty()) fs::remove(work_, ignored);
}

void OutputFile::write(const std::string& text) {
  if (path_ == "-")
    standard_output_ = text;
  else if (!path_.empty())
    write_file(work_.empty() ? path_ : work_, text, path_);
}

void OutputFile::commit() {
  if (path_ == "-") {
    std::fwrite(standard_output_.data(), 1, standard_output_.size(), stdout);
    std::fflush(stdout);
  } else if (!work_.empty()) {
    rename_over(work_, path_);
    work_.clear();
  }
}

}  // namespace dendro::study
