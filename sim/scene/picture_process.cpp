#include "sim/scene/picture_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <memory>

#include "sim/base/check.h"
#include "sim/base/error.h"
#include "sim/scene/image_io.h"

namespace dendro::scene {
namespace {

namespace fs = std::filesystem;

constexpr const char* kProgram = "libexec/dendro/dendro-pictures";

std::string program_path() {
  std::error_code error;
  const fs::path executable = fs::read_symlink("/proc/self/exe", error);
  for (fs::path at = executable; at.has_relative_path(); at = at.parent_path())
    if (const fs::path path = at.parent_path() / kProgram; ::access(path.c_str(), X_OK) == 0) return path.string();
  throw UserError(kProgram, 0, "", fmt::format("is missing in {} and above it: no picture can be read or written", executable.parent_path().string()));
}

/// The other process and the line to it; a forked process starts its own.
class Connection {
 public:
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;
  Connection() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) cannot_start(errno);
    socket_ = ends[0];
    const int error = spawn(program_path(), ends[1]);
    ::close(ends[1]);
    if (error != 0) cannot_start(error);
  }
  ~Connection() {
    ::close(socket_);
    if (owner_ == ::getpid()) end();
  }

  bool mine() const { return owner_ == ::getpid(); }
  int socket() const { return socket_; }

  /// After the line broke: why.
  std::string end() {
    int status = 0;
    while (pid_ > 0 && ::waitpid(pid_, &status, 0) < 0 && errno == EINTR) {
    }
    pid_ = -1;
    return WIFSIGNALED(status) ? fmt::format("signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)))
                               : fmt::format("status {}", WEXITSTATUS(status));
  }

 private:
  [[noreturn]] static void cannot_start(int error) {
    throw UserError(kProgram, 0, "", fmt::format("cannot be started: {}", std::strerror(error)));
  }

  int spawn(const std::string& path, int its_end) {
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_adddup2(&files, its_end, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    // Ctrl-C goes to the whole foreground, and what is begun is to be finished; with its user gone the program ends by itself.
    sigset_t blocked;
    sigemptyset(&blocked);
    sigaddset(&blocked, SIGINT);
    sigaddset(&blocked, SIGTERM);
    posix_spawnattr_setsigmask(&attributes, &blocked);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
    std::string name = path;
    char* arguments[] = {name.data(), nullptr};
    const int error = ::posix_spawn(&pid_, path.c_str(), &files, &attributes, arguments, environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&files);
    return error;
  }

  const pid_t owner_ = ::getpid();
  pid_t pid_ = -1;
  int socket_ = -1;
};

std::unique_ptr<Connection>& connection() {
  static std::unique_ptr<Connection> the_one;
  return the_one;
}

}  // namespace

void require_picture_files() { program_path(); }

PictureMessage picture_work(const nlohmann::json& head, const std::string& path, const std::vector<Span>& spans) {
  std::unique_ptr<Connection>& line = connection();
  if (!line || !line->mine()) line = std::make_unique<Connection>();
  nlohmann::json work = head;
  work["path"] = path;
  PictureMessage answer;
  if (!send_message(line->socket(), work, spans) || !receive_message(line->socket(), answer)) {
    const std::string why = line->end();
    line.reset();
    throw UserError(path, 0, "", "the program that reads and writes pictures ended with " + why);
  }
  const auto error = answer.head.find("error");
  if (error != answer.head.end())
    throw UserError(error->at("file").get<std::string>(), 0, "", error->at("message").get<std::string>());
  const auto bug = answer.head.find("bug");
  DENDRO_CHECK(bug == answer.head.end(), "{}", bug->get<std::string>());
  return answer;
}

}  // namespace dendro::scene
