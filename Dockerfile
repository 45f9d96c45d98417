# A static binary in an empty image:
#
#     docker build -t sweepsim .
#     docker run --rm -v "$PWD:/work" sweepsim verify part.ron
FROM rust:1-slim AS build
COPY . /source
# With a target that is named, the flags are not those of build scripts and macros, which cannot be static.
RUN RUSTFLAGS="-C target-feature=+crt-static" CARGO_PROFILE_RELEASE_STRIP=true \
    cargo install --locked --path /source/crates/sweepsim-cli --root /made --target "$(rustc -vV | sed -n 's/host: //p')"

FROM scratch
COPY --from=build /made/bin/sweepsim /sweepsim
WORKDIR /work
ENTRYPOINT ["/sweepsim"]
