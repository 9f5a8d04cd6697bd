# docker build -t humanwalk .
# docker run --rm -v "$PWD/runs:/humanwalk/runs" humanwalk                        # make walk
# docker run --rm -v "$PWD/runs:/humanwalk/runs" humanwalk make walk ARGS="brisk --duration 5"

FROM python:3.12-slim-bookworm AS system
# Drake needs glib, GL and EGL; dot draws diagrams, Chromium renders videos.
RUN apt-get update -qq \
    && DEBIAN_FRONTEND=noninteractive apt-get install -qq --no-install-recommends \
        chromium git graphviz libegl1 libgl1 libglib2.0-0 libopengl0 make \
    && rm -rf /var/lib/apt/lists/*
# As root, Chromium would run without its sandbox.
RUN useradd --create-home --uid 1000 walker

FROM system
WORKDIR /humanwalk
RUN chown walker /humanwalk
USER walker
# The packages change less often than the code.
COPY --chown=walker pyproject.toml requirements.lock ./
RUN python -m venv .venv && .venv/bin/pip install --quiet --no-cache-dir --no-deps --require-hashes -r requirements.lock
COPY --chown=walker . .
RUN make .venv/.installed
ENV PATH="/humanwalk/.venv/bin:$PATH"
CMD ["make", "walk"]
