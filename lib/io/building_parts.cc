// SPDX-License-Identifier: GPL-3.0-or-later
#include "io/building_parts.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <system_error>
#include <type_traits>
#include <utility>

#include "base/error.h"
#include "base/program.h"
#include "base/utf8.h"

namespace ispace {

namespace {

constexpr char kParts = 'P', kError = 'E';

[[noreturn]] void fail(const std::string& path, const std::string& message) {
    throw FormatError(Diagnostic{path, 0, 0, message});
}

template <typename T>
void append(std::string& bytes, const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <typename T>
void appendList(std::string& bytes, const std::vector<T>& values) {
    append(bytes, values.size());
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
}

class Unpacker {
  public:
    Unpacker(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {}

    [[nodiscard]] std::string_view take(std::size_t size) {
        if (rest_.size() < size) fail(path_, "bad building: what reads it did not finish");
        const std::string_view taken = rest_.substr(0, size);
        rest_.remove_prefix(size);
        return taken;
    }
    template <typename T>
    [[nodiscard]] T value() {
        T value;
        std::memcpy(&value, take(sizeof value).data(), sizeof value);
        return value;
    }
    /// A number of things that take so many bytes at least.
    [[nodiscard]] std::size_t count(std::size_t bytes) {
        const auto count = value<std::size_t>();
        if (count > rest_.size() / bytes) (void)take(rest_.size() + 1);
        return count;
    }
    template <typename T>
    [[nodiscard]] std::vector<T> list() {
        std::vector<T> values(count(sizeof(T)));
        const std::string_view bytes = take(values.size() * sizeof(T));
        if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
        return values;
    }

  private:
    std::string_view rest_;
    const std::string& path_;
};

/// Both ends of a pipe, which no other program inherits.
class Pipe {
  public:
    Pipe() {
        if (::pipe2(ends_.data(), O_CLOEXEC) != 0)
            throw std::system_error(errno, std::generic_category(), "pipe");
    }
    ~Pipe() {
        closeEnd(0);
        closeEnd(1);
    }
    Pipe(const Pipe&) = delete;
    Pipe& operator=(const Pipe&) = delete;

    [[nodiscard]] int writing() const { return ends_[1]; }
    /// All that is written, until nobody can write any more.
    std::string readAll() {
        closeEnd(1);
        std::string bytes;
        std::array<char, 1 << 16> buffer{};
        for (;;) {
            const ssize_t size = ::read(ends_[0], buffer.data(), buffer.size());
            if (size < 0 && errno == EINTR) continue;
            if (size <= 0) return bytes;
            bytes.append(buffer.data(), static_cast<std::size_t>(size));
        }
    }

  private:
    void closeEnd(std::size_t i) {
        if (ends_[i] >= 0) ::close(std::exchange(ends_[i], -1));
    }

    std::array<int, 2> ends_{-1, -1};
};

/// Runs a program with its output in the pipe and its messages nowhere; its number, or 0.
pid_t started(const std::string& program, std::vector<std::string> arguments, const Pipe& pipe) {
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, pipe.writing(), STDOUT_FILENO);
    ::posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    ::posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::vector<char*> argv;
    argv.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    char* no_settings[] = {nullptr};
    pid_t process = 0;
    const int error =
        ::posix_spawn(&process, program.c_str(), &actions, nullptr, argv.data(), no_settings);
    ::posix_spawn_file_actions_destroy(&actions);
    return error == 0 ? process : 0;
}

}  // namespace

std::vector<MeshPart> loadBuildingParts(const std::string& path, const std::string& up) {
    const std::string program =
        (std::filesystem::path(programPrefix()) / "lib" / "ispace" / "read-building").string();
    Pipe pipe;
    const pid_t process = started(program, {program, path, up}, pipe);
    if (process == 0)
        fail(path, "IFC is read by " + printable(program) + ", which cannot be started");
    const std::string bytes = pipe.readAll();
    int status = 0;
    while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status))
        fail(path, std::string("bad building: assimp, which reads it, ends by a signal (") +
                       ::strsignal(WTERMSIG(status)) + "); is the file damaged?");
    return unpackedParts(bytes, path);
}

std::string packedParts(const std::vector<MeshPart>& parts) {
    std::string bytes(1, kParts);
    append(bytes, parts.size());
    for (const MeshPart& part : parts) {
        append(bytes, part.nodes.size());
        for (const MeshNode& node : part.nodes) {
            append(bytes, node.height);
            append(bytes, node.name.size());
            bytes += node.name;
        }
        appendList(bytes, part.mesh.vertices);
        appendList(bytes, part.mesh.triangles);
    }
    return bytes;
}

std::string packedError(std::string_view message) { return kError + std::string(message); }

std::vector<MeshPart> unpackedParts(std::string_view bytes, const std::string& path) {
    Unpacker in(bytes, path);
    if (const char kind = in.value<char>(); kind != kParts)
        fail(path, kind == kError ? std::string(bytes.substr(1)) : "bad building");
    std::vector<MeshPart> parts(in.count(3 * sizeof(std::size_t)));
    for (MeshPart& part : parts) {
        part.nodes.resize(in.count(sizeof(double) + sizeof(std::size_t)));
        for (MeshNode& node : part.nodes) {
            node.height = in.value<double>();
            node.name = in.take(in.count(1));
        }
        part.mesh.vertices = in.list<std::array<float, 3>>();
        part.mesh.triangles = in.list<std::array<std::uint32_t, 3>>();
    }
    return parts;
}

}  // namespace ispace
