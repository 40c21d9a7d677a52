// SPDX-License-Identifier: GPL-3.0-or-later
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
#include <cstring>
#include <filesystem>
#include <new>
#include <set>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/error.h"
#include "base/message.h"
#include "base/number.h"
#include "base/program.h"
#include "io/ifc/building_process.h"
#include "io/mesh_file.h"
#include "io/mesh_parts.h"
#include "io/side_files.h"
#include "record/text.h"

namespace ispace {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kMaxNames = 1000;       // of side files
constexpr std::size_t kMaxName = 4096;        // bytes
constexpr std::size_t kMaxMessage = 1 << 16;  // bytes
/// An idle child is given this many times its processor time.
constexpr std::size_t kPatience = 5;

std::string ownProgram() {
    return (std::filesystem::path(programPrefix()) / "lib" / "ispace" / "read-mesh").string();
}

/// The running program and the socket to it. The destructor kills it if it still runs.
class Child {
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

    /// errno of a failed start, or 0.
    [[nodiscard]] int startError() const { return error_; }
    [[nodiscard]] int socket() const { return socket_; }
    [[nodiscard]] pid_t process() const { return process_; }

    /// Kills it if it runs; the status of wait(2), or nothing if somebody else took that.
    int end() {
        if (process_ <= 0) return 0;
        ::kill(process_, SIGKILL);  // in vain if it has ended: it is still ours to wait for
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
        // Copies first: one of them may have a number that is needed.
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
        // Assimp sets 16 MB aside for the smallest file: by 4 kB, that takes longer than all else.
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

/// What the child has to read.
struct Task {
    const std::string& path;
    RegularFile main;
    /// See read_mesh.cc: of meshes the upward axis, of buildings the height of the cut or "".
    const std::string& setting;
    bool is_building = false;
    bool side_files_anywhere = false;
    std::vector<std::string>* side_files = nullptr;
};

/// One file, one child.
class Reading {
  public:
    explicit Reading(const Task& task)
        : path_(task.path),
          task_(task),
          bytes_(task.main.size),
          limits_(meshLimits(bytes_, task.is_building)),
          child_(ownProgram(), arguments(), task.main.file.fd()) {
        if (child_.startError() != 0)
            failFile(path_, "meshes are read by " + printable(ownProgram()) +
                                ", which cannot be started: " + ::strerror(child_.startError()));
        give_up_ = Clock::now() + std::chrono::seconds(kPatience * limits_.seconds);
    }

    /// The bytes of the answer.
    std::string read() {
        for (;;) {
            std::array<char, kMeshAnswerHead> head{};
            receive(head.data(), head.size());
            std::uint64_t size = 0;
            std::memcpy(&size, head.data() + 1, sizeof size);
            switch (static_cast<MeshAnswer>(head[0])) {
                case MeshAnswer::WantsFile:
                    reply(text(size, kMaxName));
                    break;
                case MeshAnswer::Parts:
                    return text(size, limits_.memory);  // what it sends it had to hold
                case MeshAnswer::Error:
                    failFile(path_, printable(text(size, kMaxMessage)));
                case MeshAnswer::OutOfMemory:
                    tooMuchMemory();
                default:
                    noAnswer();
            }
        }
    }

  private:
    [[nodiscard]] std::vector<std::string> arguments() const {
        return {ownProgram(),
                meshSuffix(path_),
                task_.setting,
                task_.is_building ? "building" : "mesh",
                std::to_string(::getpid()),
                std::to_string(bytes_),
                std::to_string(limits_.memory),
                std::to_string(limits_.seconds)};
    }

    std::string text(std::uint64_t size, std::size_t most) {
        if (size > most) noAnswer();
        std::string bytes;
        // As it comes: nothing is set aside for what is only announced.
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
            failFile(path_, "it names more than " + std::to_string(kMaxNames) + " files");
        if (name.empty() || name.find('\0') != std::string::npos) return send(nullptr);
        const auto file = openSideFile(path_, name, task_.side_files_anywhere);
        if (!file) return send(nullptr);
        const std::string side = sideFilePath(path_, name);
        if (handed_.insert(side).second) {
            if (task_.side_files != nullptr) task_.side_files->push_back(side);
            allow(file->size);
        }
        send(&*file);
    }

    /// Larger limits, for another file.
    void allow(std::size_t bytes) {
        bytes_ += bytes;
        limits_ = meshLimits(bytes_, task_.is_building);
        const auto raise = [this](auto resource, std::size_t limit) {
            rlimit limits{};
            if (::prlimit(child_.process(), resource, nullptr, &limits) != 0) return;
            if (limits.rlim_cur == RLIM_INFINITY) return;
            limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, limit);
            ::prlimit(child_.process(), resource, &limits, nullptr);
        };
        raise(RLIMIT_AS, limits_.memory);
        raise(RLIMIT_CPU, limits_.seconds);
        give_up_ =
            std::max(give_up_, Clock::now() + std::chrono::seconds(kPatience * limits_.seconds));
    }

    void send(const RegularFile* file) {
        std::array<char, 1 + sizeof(std::uint64_t)> bytes{};
        bytes[0] = static_cast<char>(file == nullptr ? MeshReply::Missing : MeshReply::Handed);
        if (file != nullptr) {
            const std::uint64_t size = file->size;
            std::memcpy(&bytes[1], &size, sizeof size);
        }
        iovec part{bytes.data(), bytes.size()};
        msghdr message{};
        message.msg_iov = &part;
        message.msg_iovlen = 1;
        alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(int))> control{};
        if (file != nullptr) {
            message.msg_control = control.data();
            message.msg_controllen = control.size();
            cmsghdr* const head = CMSG_FIRSTHDR(&message);
            head->cmsg_level = SOL_SOCKET;
            head->cmsg_type = SCM_RIGHTS;
            head->cmsg_len = CMSG_LEN(sizeof(int));
            const int fd = file->file.fd();
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

    [[nodiscard]] std::string bad() const {
        return task_.is_building ? "bad IFC file: " : "bad mesh file: ";
    }
    [[nodiscard]] std::string forThisSize() const {
        return ", the most for " + formatBytes(bytes_) + "; is the file damaged?";
    }
    [[noreturn]] void tooMuchMemory() {
        // The user's own limit, `ulimit -v`, says nothing about the file.
        rlimit own{};
        if (::getrlimit(RLIMIT_AS, &own) == 0 && own.rlim_cur < limits_.memory)
            throw std::bad_alloc();
        failFile(path_, bad() + "it takes more than " + formatBytes(limits_.memory) + " of memory" +
                            forThisSize());
    }
    [[noreturn]] void tooMuchTime() {
        failFile(path_, bad() + "it takes more than " + std::to_string(limits_.seconds) + " s" +
                            forThisSize());
    }
    /// It died, or broke the protocol.
    [[noreturn]] void noAnswer() {
        const int status = child_.end();
        const int signal = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
        if (signal == SIGXCPU) tooMuchTime();
        if (signal != 0 && signal != SIGKILL)
            failFile(path_, bad() + (task_.is_building ? "its reader" : "assimp") +
                                " crashes on it (" + ::strsignal(signal) +
                                "); is the file damaged, or nested too deep?");
        if (WIFEXITED(status) && WEXITSTATUS(status) == 127)
            failFile(path_, "meshes are read by " + printable(ownProgram()) +
                                ", which cannot be started; is assimp installed?");
        failFile(path_, bad() + "what reads it did not finish");
    }

    const std::string& path_;
    const Task& task_;
    std::size_t bytes_;  ///< of all files handed over
    MeshLimits limits_;
    Child child_;
    Clock::time_point give_up_;
    std::size_t names_ = 0;
    std::set<std::string> handed_;
};

}  // namespace

std::shared_ptr<const TriangleMesh> loadMesh(const std::string& path, const MeshOptions& options,
                                             std::vector<std::string>* side_files) {
    if (const std::string what = foreignMesh(path); !what.empty()) failFile(path, "it is " + what);
    const Task task{path,  openRegular(path),           options.up,
                    false, options.side_files_anywhere, side_files};
    auto mesh = std::make_shared<TriangleMesh>(unpackedMesh(Reading(task).read(), path));
    if (mesh->triangles.empty()) failFile(path, "a mesh file without triangles");
    mesh->digest = meshDigest(*mesh);
    return mesh;
}

Building readBuildingInChild(std::string_view bytes, const std::string& name,
                             std::optional<double> slice) {
    RegularFile copy{OpenFile(::memfd_create("building", MFD_CLOEXEC)), bytes.size()};
    for (std::string_view rest = bytes; !rest.empty();) {
        const ssize_t written = ::write(copy.file.fd(), rest.data(), rest.size());
        if (written < 0) throw std::system_error(errno, std::generic_category(), "memfd_create");
        rest.remove_prefix(static_cast<std::size_t>(written));
    }
    const std::string setting = slice ? formatDouble(*slice) : "";
    const Task task{name, std::move(copy), setting, true};
    const std::string answer = Reading(task).read();
    try {
        return unpackedBuilding(answer);
    } catch (const std::runtime_error& error) {
        failFile(name, std::string("bad IFC file: ") + error.what());
    }
}

}  // namespace ispace
