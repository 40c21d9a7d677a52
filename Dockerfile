# SPDX-License-Identifier: GPL-3.0-or-later
# An image with the packages ispace and ispace-short-names, and the libraries that they recommend:
#
#   docker build -t ispace .
#   docker run --rm -v "$PWD:/work" -u "$(id -u):$(id -g)" ispace coverage room.env best.3dm -o map.png
#   docker run --rm -i ispace envc --to glb <room.env >room.glb
#
# The packages stand in /packages of the stage `build`: docker build --target build.
FROM debian:bookworm AS build
WORKDIR /src
RUN apt-get update \
    && apt-get install -y --no-install-recommends make \
    && rm -rf /var/lib/apt/lists/*
# The packages first: they are fetched again only where the list changes.
COPY packages.txt ./
COPY .ci/deps .ci/deps
RUN .ci/deps build package
COPY CMakeLists.txt Makefile README.md CHANGELOG.md LICENSE ./
COPY .ci .ci
COPY lib lib
COPY tools tools
COPY docs docs
COPY share share
COPY tests tests
RUN make package \
    && mkdir /packages \
    && cp build/package/*.deb /packages

FROM debian:bookworm-slim
COPY --from=build /packages /packages
RUN apt-get update \
    && apt-get install -y --no-install-recommends \
        /packages/ispace_*.deb /packages/ispace-short-names_*.deb libddsc0debian libmosquitto1 libopencv-imgcodecs406 \
    && rm -rf /var/lib/apt/lists/* /packages \
    && useradd --create-home --uid 1000 ispace
USER ispace
WORKDIR /work
ENTRYPOINT ["ispace"]
CMD ["--help"]
