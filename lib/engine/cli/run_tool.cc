// SPDX-License-Identifier: GPL-3.0-or-later
// The frame of every tool: standard streams that exist, signals with their default action, errors
// of libraries as exceptions. Statuses: 0 done, 1 failed, 2 usage, 3 a requirement is not met. An
// exception becomes messages of one form, text or JSON; products that are not committed are removed
// by OutputFile, and FileGuard keeps inputs from being overwritten. Memory that is out is told
// without memory.
#include "cli/run_tool.h"

#include <fcntl.h>
#include <gmp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/prctl.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <new>
#include <stdexcept>
#include <system_error>

#include "base/error.h"
#include "base/file.h"
#include "base/json_writer.h"
#include "base/message.h"
#include "base/run_files.h"

namespace ispace {

namespace {

enum Status { kDone = 0, kFailed = 1, kUsage = 2, kUnmet = 3 };

MessageForm message_form = MessageForm::Text;

/// The file "house.glb" from what() = "house.glb: No such file …".
Diagnostic messageOf(const std::system_error& error) {
    const std::string message = error.code().message();
    const auto* const file = dynamic_cast<const std::filesystem::filesystem_error*>(&error);
    if (file != nullptr && !file->path1().empty()) return {file->path1().string(), 0, 0, message};
    const std::string what = error.what();
    const std::string tail = ": " + message;
    if (what.size() > tail.size() && what.ends_with(tail))
        return {what.substr(0, what.size() - tail.size()), 0, 0, message};
    return {.message = what};
}

/// A file opened later must not get the number of a standard stream that the parent closed. The
/// substitute rejects every read or write, so that a lost product is an error.
void occupyStandardStreams() {
    for (const int fd : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (::fcntl(fd, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", fd == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

/// Without this the process ends if a file would grow beyond `ulimit -f`; with it writing fails. A
/// handler, unlike an ignored signal, is not inherited by other programs.
void refuseLargeFiles() {
    struct sigaction action = {};
    action.sa_handler = [](int) {};
    ::sigaction(SIGXFSZ, &action, nullptr);
}

void* orThrow(void* memory) {
    if (memory == nullptr) throw std::bad_alloc();
    return memory;
}

/// Without this GMP (exact geometry) aborts the process if memory is out.
void letNumbersThrow() {
    mp_set_memory_functions(
        [](std::size_t size) { return orThrow(std::malloc(size)); },
        [](void* old, std::size_t, std::size_t size) { return orThrow(std::realloc(old, size)); },
        [](void* memory, std::size_t) { std::free(memory); });
}

constexpr std::string_view kNoMemory = "not enough memory for this input";

/// Prints the exception. \pre within a handler
int sayException(const std::string& tool) {
    try {
        throw;
    } catch (const std::bad_alloc&) {
        sayMemoryIsOut(tool);
    } catch (const std::length_error&) {
        sayMemoryIsOut(tool);
    } catch (...) {
        const ToolFailure failure = currentFailure();
        for (const Diagnostic& message : failure.messages)
            writeMessage(tool, message, failure.status);
        return failure.status;
    }
    return kFailed;
}

}  // namespace

ToolFailure currentFailure() {
    try {
        throw;
    } catch (const UsageError& error) {
        return {kUsage, {{.message = error.what()}}};
    } catch (const UnmetError& error) {
        return {kUnmet, {{.message = error.what()}}};
    } catch (const FormatError& error) {
        return {kFailed, error.diagnostics()};
    } catch (const std::system_error& error) {
        return {kFailed, {messageOf(error)}};
    } catch (const std::bad_alloc&) {
        return {kFailed, {{.message = std::string(kNoMemory)}}};
    } catch (const std::length_error&) {
        return {kFailed, {{.message = std::string(kNoMemory)}}};
    } catch (const std::exception& error) {
        return {kFailed, {{.message = error.what()}}};
    }
}

std::vector<std::string> ToolFailure::lines() const {
    std::vector<std::string> lines;
    for (const Diagnostic& message : messages) lines.push_back(message.text());
    return lines;
}

void selectMessageForm(MessageForm form) { message_form = form; }

void writeMessage(std::string_view tool, const Diagnostic& message, int status) {
    if (message_form == MessageForm::Text)
        return writeErrorLine({tool, ": ", printable(message.text())});
    JsonWriter json;
    beginReport(json, "ispace-message/1", tool)
        .key("severity")
        .value(std::string(nameOf(message.severity)));
    if (status != 0) json.key("status").value(status);
    if (!message.file.empty()) json.key("file").value(printable(displayName(message.file)));
    if (message.line > 0) json.key("line").value(message.line);
    if (message.line > 0 && message.column > 0) json.key("column").value(message.column);
    json.key("message").value(printable(message.message)).endObject();
    writeErrorLine({json.take()});
}

void writeSentence(std::string_view tool, const Diagnostic& sentence) {
    if (message_form == MessageForm::Json) return writeMessage(tool, sentence);
    writeErrorLine({tool, ": ", printable(sentence.place() + sentence.message)});
}

void writeJobMessage(std::string_view tool, const Diagnostic& job, const Diagnostic& message) {
    if (message_form == MessageForm::Text) {
        const bool is_note = message.severity == Severity::Note;
        return writeErrorLine({tool, ": ",
                               printable(job.place() + (is_note ? message.place() + message.message
                                                                : message.text()))});
    }
    Diagnostic placed = message;
    if (placed.file.empty()) {
        placed.file = job.file;
        placed.line = job.line;
        placed.column = 0;
    }
    writeMessage(tool, placed);
}

void writeLines(std::string_view tool, std::string_view text) {
    const std::string begin = std::string(tool) + ": ";
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        if (message_form == MessageForm::Text) {
            writeErrorLine({line});
            continue;
        }
        if (line.starts_with(begin)) line.remove_prefix(begin.size());
        writeSentence(tool, {.message = std::string(line), .severity = Severity::Note});
    }
}

int runTool(const std::string& tool, const std::function<void()>& body) {
    occupyStandardStreams();
    std::signal(SIGPIPE, SIG_DFL);  // a parent may have it ignored: filters end silently
    std::signal(SIGCHLD, SIG_DFL);  // likewise: the exit status of a child could not be read
    refuseLargeFiles();
    letNumbersThrow();
    try {
        try {
            const FileGuard files;
            body();
        } catch (const TextRequested& request) {
            writeAll("-", request.text);
        }
        return kDone;
    } catch (...) {
        try {
            return sayException(tool);
        } catch (const std::exception&) {  // no memory even for a message
            sayMemoryIsOut(tool);
        }
    }
    return kFailed;
}

namespace {

/// Writes an error that ends the process, without memory. \pre `message` needs no quoting
void writeFatal(std::string_view tool, std::string_view message) {
    if (message_form == MessageForm::Text) return writeErrorLine({tool, ": error: ", message});
    writeErrorLine({R"({"schema":"ispace-message/1","tool":")", tool, R"(","version":")", version(),
                    R"(","severity":"error","status":1,"message":")", message, "\"}"});
}

/// Returns the first part of `text` that fits in one line.
std::string_view firstLine(std::string_view text) { return text.substr(0, text.find('\n')); }

/// Returns true if hardly any memory can be allocated.
bool isMemoryOut() {
    constexpr std::size_t kSome = std::size_t{1} << 20U;
    void* const some = std::malloc(kSome);
    std::free(some);
    return some == nullptr;
}

/// Prints the reason and exits; returns if the only reason is a bug.
void sayWhy(std::string_view tool) {
    if (std::current_exception()) {
        try {
            throw;
        } catch (const std::bad_alloc&) {
            return sayMemoryIsOut(tool);
        } catch (const std::length_error&) {
            return sayMemoryIsOut(tool);
        } catch (const std::exception& error) {
            return writeFatal(tool, firstLine(error.what()));
        } catch (...) {
            std::abort();
        }
    }
    // The runtime had no memory to throw with, or no exception was thrown.
    if (!isMemoryOut()) std::abort();
    sayMemoryIsOut(tool);
}

[[noreturn]] void onTerminate() {
    static std::atomic_flag is_told = ATOMIC_FLAG_INIT;
    if (is_told.test_and_set())
        while (true) ::pause();  // another thread is about to end the process
    sayWhy(::program_invocation_short_name);
    ::_exit(EXIT_FAILURE);
}

/// Runs before the initialisers of libraries, as part of a program.
using AtStart = void (*)(int, char**, char**);
[[gnu::used, gnu::section(".preinit_array")]] const AtStart kAtStart = [](int, char**, char**) {
    std::set_terminate(onTerminate);
};

/// Writes all of a text, also if stderr does not block. \returns false if it is closed
bool writeToStderr(std::string_view text) noexcept {
    while (!text.empty()) {
        const ssize_t n = ::write(STDERR_FILENO, text.data(), text.size());
        if (n >= 0) {
            text.remove_prefix(static_cast<std::size_t>(n));
        } else if (errno == EAGAIN || errno == EWOULDBLOCK) {
            pollfd ready{STDERR_FILENO, POLLOUT, 0};
            static_cast<void>(::poll(&ready, 1, -1));
        } else if (errno != EINTR) {
            return false;
        }
    }
    return true;
}

}  // namespace

void writeErrorLine(std::initializer_list<std::string_view> pieces) noexcept {
    std::array<char, 4096> part;
    std::size_t size = 0;
    const auto put = [&](std::string_view text) {
        while (!text.empty()) {
            if (size == part.size() && !writeToStderr({part.data(), std::exchange(size, 0)}))
                return;
            const std::size_t n = text.copy(part.data() + size, part.size() - size);
            size += n;
            text.remove_prefix(n);
        }
    };
    for (const std::string_view piece : pieces) put(piece);
    put("\n");
    writeToStderr({part.data(), size});
}

void sayMemoryIsOut(std::string_view tool) noexcept {
    static std::atomic_flag is_told = ATOMIC_FLAG_INIT;
    if (!is_told.test_and_set()) writeFatal(tool, kNoMemory);
}

namespace {

constexpr int kSignals[] = {SIGTERM, SIGINT};
/// Written by the handler, which can reach only globals.
std::atomic<int> last_signal = 0;
std::atomic<int> event = -1;
static_assert(std::atomic<int>::is_always_lock_free);

void handle(int signal, void (*handler)(int)) {
    struct sigaction action = {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigaction(signal, &action, nullptr);
}

void onSignal(int signal) {
    const int error = errno;
    last_signal = signal;
    static_cast<void>(!::eventfd_write(event, 1));
    // A second INT means that the user does not want to wait.
    if (signal == SIGINT) handle(signal, SIG_DFL);
    errno = error;
}

}  // namespace

StopSignals::StopSignals() : descriptor_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
    if (descriptor_ < 0) throw std::system_error(errno, std::generic_category(), "eventfd");
    last_signal = 0;
    event = descriptor_;
    // Also if they were ignored, as shells do for INT in the background: a request to this process
    // is deliberate.
    for (const int signal : kSignals) handle(signal, onSignal);
}

StopSignals::~StopSignals() {
    for (const int signal : kSignals) handle(signal, SIG_IGN);
    event = -1;
    ::close(descriptor_);
}

int StopSignals::signal() const { return last_signal; }

namespace {

[[noreturn]] void fail(const char* what) {
    throw std::system_error(errno, std::generic_category(), what);
}

/// Returns descriptors of the regular files among them, for reading and truncating.
std::vector<int> openRegular(const std::vector<std::string>& files) {
    std::vector<int> open;
    open.reserve(files.size());
    for (const std::string& file : files) {
        // Skips a link that has since replaced the file.
        const int fd = ::open(file.c_str(), O_RDWR | O_CLOEXEC | O_NONBLOCK | O_NOFOLLOW);
        struct stat info = {};
        if (fd >= 0 && ::fstat(fd, &info) == 0 && S_ISREG(info.st_mode))
            open.push_back(fd);
        else if (fd >= 0)
            ::close(fd);
    }
    return open;
}

// The code below runs in a copy of a process that has threads: system calls only, no memory.

/// Returns the number of bytes up to and including the last newline.
off_t wholeLines(int fd, off_t size) {
    std::array<char, 4096> block;
    while (size > 0) {
        const off_t begin =
            (size - 1) / static_cast<off_t>(block.size()) * static_cast<off_t>(block.size());
        const ssize_t count =
            ::pread(fd, block.data(), static_cast<std::size_t>(size - begin), begin);
        if (count < 0 && errno == EINTR) continue;
        if (count != size - begin) return -1;
        for (; size > begin; --size)
            if (block[static_cast<std::size_t>(size - begin - 1)] == '\n') return size;
    }
    return 0;
}

void cutTornLine(int fd) {
    const off_t size = ::lseek(fd, 0, SEEK_END);
    const off_t whole = wholeLines(fd, size);
    if (whole >= 0 && whole < size) static_cast<void>(!::ftruncate(fd, whole));
}

/// Closes all but `kept`, which ascend: services of the other process must end with it, and readers
/// of its output must not wait for this one.
void closeOthers(const std::vector<int>& kept) {
    unsigned int first = 0;
    for (const int fd : kept) {
        const auto next = static_cast<unsigned int>(fd);
        if (next > first) ::close_range(first, next - 1, 0);
        first = next + 1;
    }
    ::close_range(first, ~0U, 0);
}

[[noreturn]] void guard(int life, const std::vector<int>& files, const std::vector<int>& kept) {
    ::setsid();
    // So that a kill by name does not mistake it for the process it guards.
    ::prctl(PR_SET_NAME, "line-guard");
    closeOthers(kept);
    for (const int signal : {SIGTERM, SIGINT, SIGHUP, SIGPIPE}) ::signal(signal, SIG_IGN);
    char nothing = 0;
    while (::read(life, &nothing, 1) < 0 && errno == EINTR) continue;
    for (const int fd : files) cutTornLine(fd);
    ::_exit(0);
}

}  // namespace

LineGuard::LineGuard(const std::vector<std::string>& files, int lock) {
    const std::vector<int> open = openRegular(files);
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) fail("pipe to the guard of the records");
    std::vector<int> kept = open;
    kept.push_back(ends[0]);
    if (lock >= 0) kept.push_back(lock);
    std::sort(kept.begin(), kept.end());
    guard_ = ::fork();
    if (guard_ == 0) guard(ends[0], open, kept);
    const int error = errno;
    ::close(ends[0]);
    for (const int fd : open) ::close(fd);
    life_ = ends[1];
    if (guard_ < 0) {
        ::close(life_);
        errno = error;
        fail("guard of the records");
    }
}

LineGuard::~LineGuard() {
    ::close(life_);
    while (::waitpid(guard_, nullptr, 0) < 0 && errno == EINTR) continue;
}

}  // namespace ispace
