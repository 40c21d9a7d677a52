#!/usr/bin/env bash
# SPDX-License-Identifier: GPL-3.0-or-later
# -j 1 starts no thread at all; and where the system refuses threads, all of them or those after the
# first few, a tool does its work with fewer or ends with status 1 and one line.
. "$(dirname "$0")/common.sh"

! ldd "$(command -v envc)" | has 'lib[at]san' || skip "sanitizers count their own threads"
command -v cc >/dev/null || skip "no C compiler here"
ulimit -c 0

# Notes each thread in $THREAD_LOG and refuses those after the first $MOST_THREADS.
cat >count.c <<'END'
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <pthread.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <unistd.h>

static atomic_int asked;
typedef int (*Create)(pthread_t *, const pthread_attr_t *, void *(*)(void *), void *);

int pthread_create(pthread_t *thread, const pthread_attr_t *how, void *(*run)(void *), void *with) {
    const char *most = getenv("MOST_THREADS");
    const int log = open(getenv("THREAD_LOG"), O_WRONLY | O_APPEND);
    if (write(log, "thread\n", 7) != 7) abort();
    close(log);
    if (most && atomic_fetch_add(&asked, 1) >= atoi(most)) return EAGAIN;
    return ((Create)dlsym(RTLD_NEXT, "pthread_create"))(thread, how, run, with);
}
END
cc -shared -fPIC -O1 count.c -o count.so -ldl

one_job_of_each_tool

# run COMMAND…: with the library; threads are noted in ./log.
run() {
    rm -f map.png
    : >log
    THREAD_LOG=$scratch/log LD_PRELOAD=$scratch/count.so timeout 120 "$@"
}

for job in "${jobs[@]}"; do
    # shellcheck disable=SC2086
    run $job -j 1 >out
    [ ! -s log ] || fail "$(wc -l <log) threads with -j 1: $job"
    expected=$(product)
    for most in 0 1 2 3 4; do
        status=0
        # shellcheck disable=SC2086
        MOST_THREADS=$most run $job -j 4 >out 2>err || status=$?
        case $status in
            0)
                [ "$(product)" = "$expected" ] || fail "another product, $most threads: $job"
                [ ! -s err ] || fail "$most threads: $job: $(cat err)"
                ;;
            1)
                [ "$most" -gt 0 ] || fail "no thread may be had, which is no error: $job: $(cat err)"
                one_error "${job%% *}" "$job"
                ;;
            *) fail "status $status with $most threads: $job: $(cat err)" ;;
        esac
    done
done
