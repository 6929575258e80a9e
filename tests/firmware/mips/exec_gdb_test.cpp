#include <arpa/inet.h>
#include <csignal>
#include <sys/socket.h>

#include "tests/firmware/mips/shell.h"

namespace dendro::mips {
namespace {

/// A command that runs beside the test.
class Started {
 public:
  explicit Started(const std::string& command) {
    int out[2], err[2];
    EXPECT_EQ(0, ::pipe(out) + ::pipe(err));
    pid_ = ::fork();
    if (pid_ == 0) {
      ::dup2(out[1], 1);
      ::dup2(err[1], 2);
      for (const int fd : {out[0], out[1], err[0], err[1]}) ::close(fd);
      ::execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
      ::_exit(127);
    }
    ::close(out[1]);
    ::close(err[1]);
    out_ = out[0], err_ = err[0];
  }
  ~Started() {
    ::close(out_);
    ::close(err_);
  }
  std::string line_of_output() { return line(out_); }
  std::string line_of_errors() { return line(err_); }
  void signal(int number) { ::kill(pid_, number); }
  /// The rest of what it says, and its status.
  Ran end() {
    Ran ran;
    for (std::string text; !(text = line(out_)).empty();) ran.output += text;
    for (std::string text; !(text = line(err_)).empty();) ran.errors += text;
    int status = 0;
    ::waitpid(pid_, &status, 0);
    ran.status = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return ran;
  }

 private:
  static std::string line(int fd) {
    std::string text;
    for (char c = 0; c != '\n' && ::read(fd, &c, 1) == 1;) text += c;
    return text;
  }
  pid_t pid_;
  int out_, err_;
};

std::string debugged(const std::string& program, const std::string& arguments, const std::string& options) {
  return model(elf(program), arguments, "--gdb " + options) + " </dev/null";
}

/// The port of "waiting for GDB on 127.0.0.1:PORT".
int port_of(const std::string& line) {
  const std::string begin = "waiting for GDB on 127.0.0.1:";
  EXPECT_EQ(0u, line.find(begin)) << line;
  return line.size() > begin.size() ? std::atoi(line.c_str() + begin.size()) : 0;
}

int socket_at(int port, bool connects) {
  const int fd = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  auto* const any = reinterpret_cast<sockaddr*>(&address);
  EXPECT_EQ(0, connects ? ::connect(fd, any, sizeof address) : ::bind(fd, any, sizeof address) + ::listen(fd, 1));
  return fd;
}

TEST(MipsGdb, BadPortsAndLevelsAreOneLine) {
  const int taken = socket_at(0, false);
  sockaddr_in address = {};
  socklen_t size = sizeof address;
  ASSERT_EQ(0, ::getsockname(taken, reinterpret_cast<sockaddr*>(&address), &size));
  const std::string port = std::to_string(ntohs(address.sin_port));
  for (const auto& [options, wanted] :
       {std::pair<std::string, std::string>{"-1", "`-1` is not an integer in 0..65535"},
        {"65536", "`65536` is not an integer"},
        {"''", "`` is not an integer"},
        {"x", "`x` is not an integer"},
        {port, "--gdb: port " + port + " of 127.0.0.1: Address already in use"}}) {
    const Ran ran = run(debugged("hello", "", options));
    EXPECT_EQ(2, ran.status) << options;
    EXPECT_NE(std::string::npos, ran.errors.find(wanted)) << ran.errors;
    EXPECT_EQ(ran.errors.size() - 1, ran.errors.find('\n')) << ran.errors;
  }
  ::close(taken);
}

TEST(MipsGdb, AClientThatGoesAwayLeavesTheProgramToItself) {
  for (const auto& [level, text] :
       {std::pair<std::string, std::string>{"cycle", ""}, {"function", "no packet at all"}, {"estimate", "$vCont;s#b8"}, {"clocked", "$vCont;s#b8"},
        {"function", "$?#3f+$g#67+$Z0,400020,4#"}}) {
    Started program(debugged("hello", "one", "0 --level " + level));
    const int client = socket_at(port_of(program.line_of_errors()), true);
    EXPECT_EQ(static_cast<ssize_t>(text.size()), ::send(client, text.data(), text.size(), MSG_NOSIGNAL));
    ::close(client);
    const Ran ran = program.end();
    EXPECT_EQ(1, ran.status) << ran.errors;  // what the program says
    EXPECT_EQ("argument 1: one\n0 bytes\n", ran.output) << text;
    EXPECT_EQ("", ran.errors) << text;
  }
}

TEST(MipsGdb, ControlCEndsTheWaitingForGdb) {
  Started program(debugged("hello", "", "0"));
  EXPECT_GT(port_of(program.line_of_errors()), 0);
  program.signal(SIGINT);
  const Ran ran = program.end();
  EXPECT_EQ(128 + SIGINT, ran.status);
  EXPECT_EQ("dendro: interrupted\n", ran.errors);
}

TEST(MipsGdb, ControlCEndsAProgramThatRuns) {
  for (const char* level : {"function", "estimate", "cycle", "clocked"}) {
    const std::string json = scratch() + "/interrupted.json";
    Started program(model(elf("fault"), "c", std::string("--level ") + level + " --json " + json));
    EXPECT_EQ("endless\n", program.line_of_output());
    program.signal(SIGINT);
    const Ran ran = program.end();
    EXPECT_EQ(128 + SIGINT, ran.status) << level;
    EXPECT_EQ("dendro: interrupted\n", ran.errors) << level;
    EXPECT_NE(0, ::access(json.c_str(), F_OK)) << level;
  }
}

}  // namespace
}  // namespace dendro::mips
