// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/confined.h"

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <limits>
#include <new>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "base/unconfined.h"

namespace ispace {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxNames = 1000;       // of side files
constexpr std::size_t kMaxName = 4096;        // bytes
constexpr std::size_t kMaxMessage = 1 << 16;  // bytes
/// Limit of an idle child, in multiples of its processor time.
constexpr std::size_t kPatience = 5;

std::string modulePath(const std::string& program) {
    return (std::filesystem::path(programPrefix()) / "lib" / "ispace" / program).string();
}

}  // namespace

/// The running program and the socket to it. The destructor kills it if it still runs.
class ConfinedReader::Child {
  public:
    Child(const std::string& program, std::vector<std::string> arguments, int file) : socket_(-1) {
        std::array<int, 2> ends{};
        if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
            throw std::system_error(errno, std::generic_category(), "socketpair");
        socket_ = ends[0];
        OpenFile other(ends[1]);
        error_ = spawn(program, std::move(arguments), file, other.fd());
    }
    ~Child() {
        ::close(socket_);
        (void)end();
    }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    /// errno of a failed start, else 0.
    [[nodiscard]] int startError() const { return error_; }
    [[nodiscard]] int socket() const { return socket_; }
    [[nodiscard]] pid_t process() const { return process_; }
    /// Processor time used, in whole seconds.
    [[nodiscard]] std::size_t seconds() const {
        clockid_t clock{};
        timespec time{};
        if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &time) != 0)
            return 0;
        return static_cast<std::size_t>(time.tv_sec) + 1;
    }

    /// Kills the process if it runs. \return the status of wait(2), 0 if unknown
    int end() {
        if (process_ <= 0) return 0;
        ::kill(process_, SIGKILL);  // a process that has ended must still be waited for
        int status = 0;
        pid_t waited = 0;
        do waited = ::waitpid(process_, &status, 0);
        while (waited < 0 && errno == EINTR);
        process_ = 0;
        return waited < 0 ? 0 : status;
    }

  private:
    int spawn(const std::string& program, std::vector<std::string> arguments, int file, int other) {
        std::vector<char*> argv;
        argv.reserve(arguments.size() + 1);
        for (std::string& argument : arguments) argv.push_back(argument.data());
        argv.push_back(nullptr);
        // Copies first: one of them may have a number that is required.
        const OpenFile file_copy(::fcntl(file, F_DUPFD_CLOEXEC, 3));
        const OpenFile other_copy(::fcntl(other, F_DUPFD_CLOEXEC, 3));
        if (file_copy.fd() < 0 || other_copy.fd() < 0) return errno;
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, file_copy.fd(), STDIN_FILENO);
        ::posix_spawn_file_actions_adddup2(&actions, other_copy.fd(), STDOUT_FILENO);
        ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
        ::posix_spawn_file_actions_addclosefrom_np(&actions, 3);
        posix_spawnattr_t attributes;
        ::posix_spawnattr_init(&attributes);
        sigset_t signals;
        ::sigemptyset(&signals);
        ::posix_spawnattr_setsigmask(&attributes, &signals);
        ::sigfillset(&signals);
        ::posix_spawnattr_setsigdefault(&attributes, &signals);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK | POSIX_SPAWN_SETSIGDEF);
        // Assimp allocates 16 MB for the smallest file; in steps of 4 kB that takes most of the
        // time.
        std::string pages = "GLIBC_TUNABLES=glibc.malloc.hugetlb=1";
        std::array<char*, 2> settings{pages.data(), nullptr};
        const int error = ::posix_spawn(&process_, program.c_str(), &actions, &attributes,
                                        argv.data(), settings.data());
        ::posix_spawnattr_destroy(&attributes);
        ::posix_spawn_file_actions_destroy(&actions);
        if (error != 0) process_ = 0;
        return error;
    }

    int socket_;
    pid_t process_ = 0;
    int error_ = 0;
};

/// Reads one file.
class ConfinedReader::Reading {
  public:
    Reading(const ConfinedTask& task, ConfinedReader& reader)
        : task_(task),
          bytes_(task.bytes),
          limits_(task.limits(bytes_)),
          is_next_(reader.child_ != nullptr),
          child_(is_next_ ? *reader.child_ : start(reader)) {
        if (child_.startError() != 0)
            fail(task_.subject + " read by " + printable(modulePath(task_.program)) +
                 ", which cannot be started: " + ::strerror(child_.startError()) + task_.hint);
        give_up_ = Clock::now() + std::chrono::seconds(kPatience * limits_.seconds);
        if (!is_next_) return;
        spent_ = child_.seconds();
        setLimits();
        send(task_.file, bytes_);
    }

    /// Returns the bytes of the answer.
    std::string read() {
        for (;;) {
            std::array<char, kConfinedHead> head{};
            receive(head.data(), head.size());
            std::uint64_t size = 0;
            std::memcpy(&size, head.data() + 1, sizeof size);
            switch (static_cast<ConfinedAnswer>(head[0])) {
                case ConfinedAnswer::WantsFile:
                    reply(text(size, kMaxName));
                    break;
                case ConfinedAnswer::Work:
                    pay(size);
                    break;
                case ConfinedAnswer::TooMuchWork:
                    tooMuchWork(printable(text(size, kMaxMessage)));
                case ConfinedAnswer::Result:
                    return text(size, limits_.memory);  // the program held its result in memory
                case ConfinedAnswer::Error:
                    fail(task_.problem + printable(text(size, kMaxMessage)));
                case ConfinedAnswer::OutOfMemory:
                    tooMuchMemory();
                default:
                    noAnswer();
            }
        }
    }

  private:
    Child& start(ConfinedReader& reader) {
        ++reader.starts_;
        reader.child_ = std::make_unique<Child>(modulePath(task_.program), arguments(), task_.file);
        return *reader.child_;
    }

    [[nodiscard]] std::vector<std::string> arguments() const {
        std::vector<std::string> words{modulePath(task_.program)};
        words.insert(words.end(), task_.arguments.begin(), task_.arguments.end());
        const std::uint64_t units =
            task_.work == nullptr ? std::numeric_limits<std::uint64_t>::max() : task_.work->left();
        for (const std::uint64_t number :
             {static_cast<std::uint64_t>(::getpid()), std::uint64_t{bytes_},
              std::uint64_t{limits_.memory}, std::uint64_t{limits_.seconds}, units,
              std::uint64_t{mayReadUnconfined() ? 1U : 0U}})
            words.push_back(std::to_string(number));
        return words;
    }

    void pay(std::uint64_t size) {
        std::uint64_t units = 0;
        if (size != sizeof units) noAnswer();
        receive(reinterpret_cast<char*>(&units), sizeof units);
        if (task_.work != nullptr && !task_.work->take(units)) noAnswer();  // beyond its bound
    }

    void payAll() const {
        if (task_.work != nullptr) static_cast<void>(task_.work->take(task_.work->left()));
    }

    [[noreturn]] void tooMuchWork(const std::string& cause) {
        if (task_.work == nullptr || task_.work->take(task_.work->left() + 1)) noAnswer();
        fail(task_.problem + cause + " make " + task_.work->excess());
    }

    std::string text(std::uint64_t size, std::size_t most) {
        if (size > most) noAnswer();
        std::string bytes;
        // Grows with the bytes received; the announced size is not allocated at once.
        while (bytes.size() < size) {
            constexpr std::size_t kPiece = 1 << 22;
            const std::size_t at = bytes.size();
            const std::size_t piece = std::min<std::size_t>(size - at, kPiece);
            if (bytes.capacity() < at + piece)
                bytes.reserve(std::min<std::size_t>(size, std::max(2 * at, piece)));
            bytes.resize(at + piece);
            receive(bytes.data() + at, piece);
        }
        return bytes;
    }

    void receive(char* to, std::size_t size) {
        while (size > 0) {
            await(POLLIN);
            const ssize_t got = ::recv(child_.socket(), to, size, MSG_DONTWAIT);
            if (got < 0 && (errno == EINTR || errno == EAGAIN)) continue;
            if (got <= 0) noAnswer();
            to += got;
            size -= static_cast<std::size_t>(got);
        }
    }

    void await(short event) {
        for (;;) {
            const auto left =
                std::chrono::ceil<std::chrono::milliseconds>(give_up_ - Clock::now()).count();
            if (left <= 0) tooMuchTime();
            pollfd wanted{child_.socket(), event, 0};
            const int ready = ::poll(&wanted, 1, static_cast<int>(std::min<long>(left, 1'000'000)));
            if (ready > 0) return;
            if (ready < 0 && errno != EINTR)
                throw std::system_error(errno, std::generic_category(), "poll");
        }
    }

    void reply(const std::string& name) {
        if (++names_ > kMaxNames)
            fail("it names more than " + std::to_string(kMaxNames) + " files");
        if (!task_.open || name.empty() || name.find('\0') != std::string::npos) return send(-1, 0);
        const auto file = task_.open(name);
        if (!file) return send(-1, 0);
        if (handed_.insert(name).second) allow(file->size);
        send(file->file.fd(), file->size);
    }

    /// Raises the limits for another file.
    void allow(std::size_t bytes) {
        bytes_ += bytes;
        limits_ = task_.limits(bytes_);
        setLimits();
        give_up_ =
            std::max(give_up_, Clock::now() + std::chrono::seconds(kPatience * limits_.seconds));
    }

    void setLimits() const {
        const auto set = [this](auto resource, std::size_t limit) {
            rlimit limits{};
            if (::prlimit(child_.process(), resource, nullptr, &limits) != 0) return;
            if (limits.rlim_cur == RLIM_INFINITY) return;
            limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, limit);
            ::prlimit(child_.process(), resource, &limits, nullptr);
        };
        set(RLIMIT_AS, limits_.memory);
        set(RLIMIT_CPU, spent_ + limits_.seconds);
    }

    /// \param fd of the file, or -1
    void send(int fd, std::uint64_t size) {
        std::array<char, 1 + sizeof size> bytes{};
        bytes[0] = static_cast<char>(fd < 0 ? ConfinedReply::Missing : ConfinedReply::Handed);
        std::memcpy(&bytes[1], &size, sizeof size);
        iovec part{bytes.data(), bytes.size()};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
        if (fd >= 0) {
            message.msg_control = control.data();
            message.msg_controllen = control.size();
            cmsghdr* const head = CMSG_FIRSTHDR(&message);
            head->cmsg_level = SOL_SOCKET;
            head->cmsg_type = SCM_RIGHTS;
            head->cmsg_len = CMSG_LEN(sizeof(int));
            std::memcpy(CMSG_DATA(head), &fd, sizeof fd);
        }
        for (;;) {
            await(POLLOUT);
            const ssize_t sent = ::sendmsg(child_.socket(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
            if (sent == static_cast<ssize_t>(bytes.size())) return;
            if (sent < 0 && (errno == EINTR || errno == EAGAIN)) continue;
            noAnswer();
        }
    }

    [[noreturn]] void fail(const std::string& message) const {
        throw FormatError({displayName(task_.name), 0, 0, message});
    }
    [[nodiscard]] std::string bad() const { return "bad " + task_.kind + ": "; }
    [[nodiscard]] std::string forThisSize() const {
        return ", the most for " + formatBytes(bytes_) + "; is the file damaged?";
    }
    [[noreturn]] void tooMuchMemory() {
        // The user's own limit, `ulimit -v`, is independent of the file.
        rlimit own{};
        if (::getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur < limits_.memory)
            throw std::bad_alloc();
        fail(bad() + "it takes more than " + formatBytes(limits_.memory) + " of memory" +
             forThisSize());
    }
    [[noreturn]] void tooMuchTime() {
        payAll();
        fail(bad() + "it takes more than " + std::to_string(limits_.seconds) + " s" +
             forThisSize());
    }
    /// The program has died or broken the protocol.
    [[noreturn]] void noAnswer() {
        const int status = child_.end();
        payAll();
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        if (signal == SIGXCPU) tooMuchTime();
        if (signal != 0 && signal != SIGKILL)
            fail(bad() + task_.reader + " crashes on it (" + ::strsignal(signal) +
                 "); is the file damaged, or nested too deep?");
        if (WIFEXITED(status) && WEXITSTATUS(status) == kNotConfined)
            fail(task_.subject + " read by " + printable(modulePath(task_.program)) +
                 ", whose rights this system does not take away (it has no seccomp, or refuses "
                 "it): a file that you trust is read with --unconfined");
        if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
            fail(task_.subject + " read by " + printable(modulePath(task_.program)) +
                 ", which cannot be started" + task_.hint);
        fail(bad() + "what reads it did not finish");
    }

    const ConfinedTask& task_;
    std::size_t bytes_;  ///< of all files handed over
    ConfinedLimits limits_;
    bool is_next_;  ///< the program runs already
    Child& child_;
    std::size_t spent_ = 0;  ///< seconds that files before this one took
    Clock::time_point give_up_;
    std::size_t names_ = 0;
    std::set<std::string> handed_;
};

bool& mayReadUnconfined() {
    static bool may = false;
    return may;
}

ConfinedReader::ConfinedReader() = default;
ConfinedReader::~ConfinedReader() = default;

std::string ConfinedReader::read(const ConfinedTask& task) {
    try {
        return Reading(task, *this).read();
    } catch (...) {
        child_ = nullptr;
        throw;
    }
}

OpenFile fileInMemory(std::string_view bytes) {
    OpenFile file(::memfd_create("input", MFD_CLOEXEC));
    while (!bytes.empty()) {
        const ssize_t written = ::write(file.fd(), bytes.data(), bytes.size());
        if (written < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
        bytes.remove_prefix(static_cast<std::size_t>(written));
    }
    return file;
}

}  // namespace ispace
