# karst without a compiler of your own (docs/install.md):
#   docker build -t karst .
#   docker run --rm -v "$PWD:/work" karst cave generate --preset small --seed 7 --out cave
#   docker run --rm -v "$PWD:/work" karst fly --cave cave.info --policy nearest_frontier --out run
FROM debian:12-slim AS build
WORKDIR /karst
RUN apt-get update && apt-get install -y --no-install-recommends make
# Before the sources: a change of theirs installs nothing again.
COPY .ci .ci
RUN .ci/install build && .ci/install deb
COPY . .
RUN make deb

# Nothing but what the packages need. Tests of karst carry out these lines in a clean root.
FROM debian:12-slim
COPY --from=build /karst/build/packages/*.deb /tmp/packages/
RUN apt-get update && \
    apt-get install -y --no-install-recommends /tmp/packages/*.deb && \
    rm -rf /tmp/packages /var/lib/apt/lists/*
WORKDIR /work
ENTRYPOINT ["karst"]
CMD ["--help"]
