// SPDX-License-Identifier: GPL-3.0-or-later
// Requests on stdin: a decimal length and a line end, then fields that end in NUL: folder, files
// for stdout and stderr, words of the command line. Answers on stdout: the status in decimal and a
// line end. A job is a fork of a process that has read rooms and devices already; if threads exist,
// which a fork would lose, the program begins anew. Children die with the server.
#include "cli/job_server.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstddef>
#include <filesystem>
#include <iterator>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "cli/common_options.h"
#include "cli/job_loop.h"
#include "cli/run_tool.h"

namespace ispace {

namespace {

constexpr std::string_view kServe = "--serve-jobs";

[[noreturn]] void fail(const std::string& what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// Reads up to `size` bytes; fewer at the end of stdin.
std::string readBytes(std::size_t size) {
    std::string bytes(size, '\0');
    std::size_t count = 0;
    while (count < size) {
        const ssize_t n = ::read(STDIN_FILENO, bytes.data() + count, size - count);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) fail("stdin");
        if (n == 0) break;
        count += static_cast<std::size_t>(n);
    }
    bytes.resize(count);
    return bytes;
}

struct Job {
    std::string folder, output, errors;
    std::vector<std::string> words;
};

/// Returns the next job; empty at the end of stdin. \throws UsageError for bytes that are no
/// request
std::optional<Job> nextJob() {
    constexpr std::size_t kMostBytes = std::size_t{1} << 24U;
    std::string number;
    for (std::string byte = readBytes(1); byte != "\n"; byte = readBytes(1)) {
        if (byte.empty() && number.empty()) return std::nullopt;
        number += byte;
        if (byte.empty() || number.size() > 9) throw UsageError(std::string(kServe) + ": no job");
    }
    std::size_t size = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), size);
    const std::string bytes = size <= kMostBytes ? readBytes(size) : "";
    if (error != std::errc() || end != number.data() + number.size() || bytes.size() != size ||
        !bytes.ends_with('\0'))
        throw UsageError(std::string(kServe) + ": no job");
    std::vector<std::string> fields;
    for (std::size_t begin = 0; begin < bytes.size();) {
        const std::size_t stop = bytes.find('\0', begin);
        fields.push_back(bytes.substr(begin, stop - begin));
        begin = stop + 1;
    }
    constexpr std::ptrdiff_t kBeforeWords = 3;
    if (std::ssize(fields) < kBeforeWords)
        throw UsageError(std::string(kServe) + ": a job has a folder and two files");
    return Job{fields[0], fields[1], fields[2], {fields.begin() + kBeforeWords, fields.end()}};
}

/// Replaces a standard stream by a file. \param file "": /dev/null
void redirect(int stream, const std::string& file) {
    const char* const name = file.empty() ? "/dev/null" : file.c_str();
    const int flags = stream == STDIN_FILENO ? O_RDONLY : O_WRONLY | O_CREAT | O_TRUNC;
    constexpr mode_t kMode = 0666;
    const int fd = ::open(name, flags | O_CLOEXEC, kMode);
    if (fd < 0 || ::dup2(fd, stream) < 0) fail(name);
    ::close(fd);
}

bool hasOneThread() {
    std::error_code error;
    const std::filesystem::directory_iterator threads("/proc/self/task", error);
    return !error && std::distance(begin(threads), end(threads)) == 1;
}

std::vector<char*> argumentsOf(std::string& tool, std::vector<std::string>& words) {
    std::vector<char*> argv = {tool.data()};
    for (std::string& word : words) argv.push_back(word.data());
    argv.push_back(nullptr);
    return argv;
}

/// The status of a child that has ended.
int statusOf(pid_t child) {
    int status = 0;
    while (::waitpid(child, &status, 0) < 0)
        if (errno != EINTR) fail("a job");
    constexpr int kSignalled = 128;
    return WIFSIGNALED(status) ? kSignalled + WTERMSIG(status) : WEXITSTATUS(status);
}

/// In the child: stands in for a separate process. \param is_alone false: other threads were
/// lost by the fork, so the program begins anew
int work(std::string tool, Job job, const std::function<void(int, char**)>& body, bool is_alone) {
    std::vector<char*> argv = argumentsOf(tool, job.words);
    if (!is_alone) {
        ::execv("/proc/self/exe", argv.data());
        fail("/proc/self/exe");
    }
    return runTool(tool, [&] { body(static_cast<int>(argv.size()) - 1, argv.data()); });
}

void answer(int status) {
    const std::string line = std::to_string(status) + '\n';
    if (::write(STDOUT_FILENO, line.data(), line.size()) != std::ssize(line)) fail("stdout");
}

/// The process that reads requests and forks for each; a child returns with its status.
class JobServer {
  public:
    JobServer(std::string tool, const std::function<void(int, char**)>& body)
        : tool_(std::move(tool)), body_(body) {
        ::prctl(PR_SET_PDEATHSIG, SIGKILL);
        std::signal(SIGCHLD, SIG_DFL);
        static_cast<void>(shippedDevices());  // which most jobs want
    }

    int run() {
        runJobs(LoopThreads::One, [this]() -> std::optional<LoopJob> {
            std::optional<Job> job = nextJob();
            if (!job) return std::nullopt;
            if (::chdir(job->folder.c_str()) != 0) fail(job->folder);
            is_alone_ = hasOneThread();
            // A copy of a process with threads begins anew, and has no room.
            std::vector<std::string> rooms = is_alone_ ? job->words : std::vector<std::string>();
            return LoopJob{std::move(rooms), [this, job = *std::move(job)] { return fork(job); }};
        });
        return status_;
    }

  private:
    /// Does a job in a child. \return the delivery of its status; in the child, after its job, none
    std::function<void()> fork(const Job& job) {
        is_alone_ = is_alone_ && hasOneThread();
        const pid_t server = ::getpid();
        const pid_t child = ::fork();
        if (child < 0) fail("a job");
        if (child == 0) {
            ::prctl(PR_SET_PDEATHSIG, SIGKILL);
            if (::getppid() != server) ::_exit(1);
            redirect(STDIN_FILENO, "");
            redirect(STDOUT_FILENO, job.output);
            redirect(STDERR_FILENO, job.errors);
            status_ = work(tool_, job, body_, is_alone_);
            return {};
        }
        return [status = statusOf(child)] { answer(status); };
    }

    std::string tool_;
    const std::function<void(int, char**)>& body_;
    bool is_alone_ = true;
    int status_ = 0;
};

}  // namespace

int runTool(const std::string& tool, int argc, char** argv,
            const std::function<void(int, char**)>& body) {
    if (argc != 2 || argv[1] != kServe) return runTool(tool, [&] { body(argc, argv); });
    int status = 0;
    const int failed = runTool(tool, [&] { status = JobServer(tool, body).run(); });
    return failed != 0 ? failed : status;
}

}  // namespace ispace
