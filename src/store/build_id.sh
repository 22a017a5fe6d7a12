#!/bin/sh
# build_id.sh SRCDIR VERSION: print build_id.c. The commit is that of SRCDIR's own repository, never of one around it;
# without a repository (a release archive) a hash of the sources stands for it. CFLAGS comes from the environment.
set -eu
srcdir=$1 version=$2

quoted() { printf '%s' "$1" | tr '\n' ' ' | sed 's/\\/\\\\/g; s/"/\\"/g'; }

git=
if [ -e "$srcdir/.git" ]; then
    git=$(git -C "$srcdir" describe --always --dirty --abbrev=12 --exclude='*' 2>/dev/null) || git=
fi
if [ -z "$git" ]; then
    git=src-$(cd "$srcdir" && find src machines scenarios plots -type f ! -name schema.c ! -name build_id.c \
        \( -name '*.[chS]' -o -name '*.sql' -o -name '*.gp' -o -name '*.yaml' \) | LC_ALL=C sort |
        xargs cat | sha256sum | cut -c1-12)
fi

cat <<END
/* Made by build_id.sh. */
#include "store/build.h"

#if defined(__clang__)
#define COMPILER "clang " __clang_version__
#else
#define COMPILER "gcc " __VERSION__
#endif

struct build store_build(void)
{
    return (struct build){"$(quoted "$version")", "$(quoted "$git")", COMPILER, "$(quoted "${CFLAGS:-}")"};
}
END
