/* SPDX-License-Identifier: GPL-3.0-or-later
 * Preloaded by faults.py. From the first line of main() on it counts allocations and system calls,
 * and lets some of them fail: FAULT=KIND,N,MOST is the N-th of a KIND and those after it, MOST in
 * all (0: all of them). KIND is alloc, call, or short: calls that succeed with less than was asked
 * for, or are interrupted, which is no error. FAULT_COUNTS is a file of two 64-bit counts, which
 * may be read whatever becomes of the process. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <execinfo.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/epoll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

extern void* __libc_malloc(size_t size);
extern void* __libc_calloc(size_t count, size_t size);
extern void* __libc_realloc(void* old, size_t size);
extern void* __libc_memalign(size_t alignment, size_t size);

enum Kind { kAlloc, kCall, kShort };
static atomic_int armed;
static enum Kind kind;
static long nth, most;
static atomic_long own[2];
static atomic_long* counts = own;

/* Callers that crash by themselves where memory ends. An error of Cairo's rasteriser jumps to a
 * frame that has returned (cairo-tor-scan-converter.c, 1.16); the dynamic linker ends a process
 * that it has no thread-local data for. */
static int is_hopeless(const void* caller) {
    Dl_info info;
    if (!dladdr(caller, &info) || !info.dli_fname) return 0;
    return strstr(info.dli_fname, "/libcairo.") || strstr(info.dli_fname, "/libpixman-") ||
           strstr(info.dli_fname, "/ld-linux");
}

/* Whether the next of a kind fails: it counts as an allocation or as a call. */
static int fails(enum Kind what) {
    if (!atomic_load_explicit(&armed, memory_order_relaxed)) return 0;
    const long count = 1 + atomic_fetch_add(&counts[what == kAlloc ? kAlloc : kCall], 1);
    return what == kind && nth > 0 && count >= nth && (most == 0 || count < nth + most);
}

/* read() and write() count once, whether they are to fail or to fall short. */
static int shorter(int failed, size_t* size) {
    const long count = atomic_load(&counts[kCall]);
    if (failed || !atomic_load(&armed) || kind != kShort || nth <= 0 || count < nth) return 0;
    if (most != 0 && count >= nth + most) return 0;
    if (count % 3 == 0) return 1;
    *size = *size > 1 ? (*size + 1) / 2 : *size;
    return 0;
}

static void* real(const char* name) { return dlsym(RTLD_NEXT, name); }

/* --- allocations */

#define alloc_fails()                                      \
    (atomic_load_explicit(&armed, memory_order_relaxed) && \
     !is_hopeless(__builtin_return_address(0)) && fails(kAlloc))

void* malloc(size_t size) {
    if (alloc_fails()) return errno = ENOMEM, NULL;
    return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
    if (alloc_fails()) return errno = ENOMEM, NULL;
    return __libc_calloc(count, size);
}
void* realloc(void* old, size_t size) {
    if (alloc_fails()) return errno = ENOMEM, NULL;
    return __libc_realloc(old, size);
}
void* memalign(size_t alignment, size_t size) {
    if (alloc_fails()) return errno = ENOMEM, NULL;
    return __libc_memalign(alignment, size);
}
void* aligned_alloc(size_t alignment, size_t size) { return memalign(alignment, size); }
int posix_memalign(void** result, size_t alignment, size_t size) {
    void* made = memalign(alignment, size);
    if (!made) return ENOMEM;
    *result = made;
    return 0;
}

/* --- system calls */

#define WRAP(type, failure, error, name, parameters, arguments) \
    type name parameters {                                      \
        static type(*next) parameters;                          \
        if (!next) next = (type(*) parameters)real(#name);      \
        if (fails(kCall)) return errno = error, failure;        \
        return next arguments;                                  \
    }

WRAP(FILE*, NULL, EMFILE, fopen, (const char* path, const char* mode), (path, mode))
WRAP(FILE*, NULL, EMFILE, fopen64, (const char* path, const char* mode), (path, mode))
WRAP(int, -1, EIO, fsync, (int fd), (fd))
WRAP(int, -1, EIO, fdatasync, (int fd), (fd))
WRAP(int, -1, EFBIG, ftruncate, (int fd, off_t size), (fd, size))
WRAP(int, -1, EFBIG, ftruncate64, (int fd, off64_t size), (fd, size))
WRAP(int, -1, EACCES, rename, (const char* from, const char* to), (from, to))
WRAP(int, -1, EACCES, renameat2, (int a, const char* from, int b, const char* to, unsigned how),
     (a, from, b, to, how))
WRAP(int, -1, EACCES, linkat, (int a, const char* from, int b, const char* to, int how),
     (a, from, b, to, how))
WRAP(int, -1, EACCES, link, (const char* from, const char* to), (from, to))
WRAP(int, -1, ENOSPC, mkdir, (const char* path, mode_t mode), (path, mode))
WRAP(void*, MAP_FAILED, ENOMEM, mmap,
     (void* at, size_t size, int access, int how, int fd, off_t from),
     (at, size, access, how, fd, from))
WRAP(void*, MAP_FAILED, ENOMEM, mmap64,
     (void* at, size_t size, int access, int how, int fd, off64_t from),
     (at, size, access, how, fd, from))
WRAP(ssize_t, -1, EIO, pread, (int fd, void* to, size_t size, off_t from), (fd, to, size, from))
WRAP(ssize_t, -1, EIO, pread64, (int fd, void* to, size_t size, off64_t from), (fd, to, size, from))
WRAP(ssize_t, -1, ENOSPC, pwrite, (int fd, const void* from, size_t size, off_t to),
     (fd, from, size, to))
WRAP(ssize_t, -1, ENOSPC, pwrite64, (int fd, const void* from, size_t size, off64_t to),
     (fd, from, size, to))
WRAP(int, -1, EMFILE, socket, (int domain, int type, int protocol), (domain, type, protocol))
WRAP(int, -1, EADDRINUSE, bind, (int fd, const struct sockaddr* to, socklen_t size), (fd, to, size))
WRAP(int, -1, EADDRINUSE, listen, (int fd, int waiting), (fd, waiting))
WRAP(ssize_t, -1, ECONNRESET, recv, (int fd, void* to, size_t size, int how), (fd, to, size, how))
WRAP(ssize_t, -1, ECONNRESET, recvmsg, (int fd, struct msghdr* to, int how), (fd, to, how))
WRAP(ssize_t, -1, EPIPE, send, (int fd, const void* from, size_t size, int how),
     (fd, from, size, how))
WRAP(ssize_t, -1, EPIPE, sendmsg, (int fd, const struct msghdr* from, int how), (fd, from, how))
WRAP(int, -1, EMFILE, epoll_create1, (int how), (how))
WRAP(int, -1, EMFILE, eventfd, (unsigned value, int how), (value, how))
WRAP(int, -1, EMFILE, timerfd_create, (int clock, int how), (clock, how))
WRAP(int, -1, EMFILE, pipe, (int both[2]), (both))
WRAP(int, -1, EMFILE, pipe2, (int both[2], int how), (both, how))

static int opened(int failed, int folder, const char* path, int flags, mode_t mode) {
    if (failed) return errno = (flags & O_ACCMODE) == O_RDONLY ? EMFILE : ENOSPC, -1;
    return (int)syscall(SYS_openat, folder, path, flags, mode);
}
#define MODE_OF(flags)                     \
    mode_t mode = 0;                       \
    if (flags & (O_CREAT | __O_TMPFILE)) { \
        va_list rest;                      \
        va_start(rest, flags);             \
        mode = va_arg(rest, mode_t);       \
        va_end(rest);                      \
    }
int open(const char* path, int flags, ...) {
    MODE_OF(flags)
    return opened(fails(kCall), AT_FDCWD, path, flags, mode);
}
int open64(const char* path, int flags, ...) {
    MODE_OF(flags)
    return opened(fails(kCall), AT_FDCWD, path, flags, mode);
}
int __open_2(const char* path, int flags) { return opened(fails(kCall), AT_FDCWD, path, flags, 0); }
int __open64_2(const char* path, int flags) {
    return opened(fails(kCall), AT_FDCWD, path, flags, 0);
}
int openat(int folder, const char* path, int flags, ...) {
    MODE_OF(flags)
    return opened(fails(kCall), folder, path, flags, mode);
}
int openat64(int folder, const char* path, int flags, ...) {
    MODE_OF(flags)
    return opened(fails(kCall), folder, path, flags, mode);
}

/* The error line of a tool is never lost. */
ssize_t read(int fd, void* to, size_t size) {
    const int failed = fails(kCall);
    if (failed) return errno = EIO, -1;
    if (shorter(failed, &size)) return errno = EINTR, -1;
    return syscall(SYS_read, fd, to, size);
}
ssize_t write(int fd, const void* from, size_t size) {
    const int failed = fd != 2 && fails(kCall);
    if (failed) return errno = ENOSPC, -1;
    if (shorter(failed, &size)) return errno = EINTR, -1;
    return syscall(SYS_write, fd, from, size);
}
ssize_t writev(int fd, const struct iovec* parts, int count) {
    const int failed = fd != 2 && fails(kCall);
    if (failed) return errno = ENOSPC, -1;
    size_t size = count > 0 ? parts[0].iov_len : 0;
    const size_t all = size;
    if (shorter(failed, &size)) return errno = EINTR, -1;
    if (size < all) return syscall(SYS_write, fd, parts[0].iov_base, size);
    return syscall(SYS_writev, fd, parts, count);
}

/* --- begin */

static void read_orders(void) {
    const char *fault = getenv("FAULT"), *file = getenv("FAULT_COUNTS");
    if (fault) {
        kind = !strncmp(fault, "alloc", 5) ? kAlloc : !strncmp(fault, "call", 4) ? kCall : kShort;
        const char* comma = strchr(fault, ',');
        if (!comma || sscanf(comma, ",%ld,%ld", &nth, &most) != 2) abort();
    }
    if (!file) return;
    const long fd = syscall(SYS_openat, AT_FDCWD, file, O_RDWR | O_CREAT, 0600);
    if (fd < 0 || syscall(SYS_ftruncate, fd, (long)sizeof own)) abort();
    counts = (atomic_long*)syscall(SYS_mmap, NULL, sizeof own, PROT_READ | PROT_WRITE, MAP_SHARED,
                                   fd, 0);
    if (counts == (void*)MAP_FAILED) abort();
    syscall(SYS_close, fd);
}

/* Says where a process aborts. */
static void on_abort(int number) {
    void* calls[64];
    atomic_store(&armed, 0);
    backtrace_symbols_fd(calls, backtrace(calls, 64), 2);
    signal(number, SIG_DFL);
    raise(number);
}

typedef int Main(int, char**, char**);
static Main* real_main;
static int counted_main(int argc, char** argv, char** environment) {
    signal(SIGABRT, on_abort);
    read_orders();
    atomic_store(&armed, 1);
    const int status = real_main(argc, argv, environment);
    atomic_store(&armed, 0);
    return status;
}
int __libc_start_main(Main* main, int argc, char** argv, void (*init)(void), void (*fini)(void),
                      void (*end)(void), void* stack) {
    typedef int Start(Main*, int, char**, void (*)(void), void (*)(void), void (*)(void), void*);
    real_main = main;
    return ((Start*)real("__libc_start_main"))(counted_main, argc, argv, init, fini, end, stack);
}
