# A static binary in an empty image. This file is untested.
#
#     docker build -t sweepsim .
#     docker run --rm -v "$PWD:/work" sweepsim verify part.ron
FROM rust:1-alpine AS build
RUN apk add --no-cache musl-dev
COPY . /source
RUN cargo install --locked --path /source/crates/sweepsim-cli --root /made

FROM scratch
COPY --from=build /made/bin/sweepsim /sweepsim
WORKDIR /work
ENTRYPOINT ["/sweepsim"]
