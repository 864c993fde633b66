# Galatea in one image: the API with the web page (`galatea serve`) and the workers (`galatea worker`).
# Linux on x86-64 only, as two of the packages have no other builds.

FROM node:22.12-bookworm-slim AS page
WORKDIR /page
COPY web/package.json web/package-lock.json web/.npmrc ./
RUN npm ci --no-progress
COPY web .
COPY docs /docs
RUN npm run build && npm run build:reactive && cp reactive/dist/reactive-portrait.js dist/ \
 && node compress.mjs dist

FROM python:3.11.11-slim-bookworm AS packages
ENV PIP_NO_CACHE_DIR=1 PIP_DISABLE_PIP_VERSION_CHECK=1
RUN python -m venv /opt/galatea
COPY requirements.lock .
RUN /opt/galatea/bin/pip install --no-deps --require-hashes -r requirements.lock

FROM python:3.11.11-slim-bookworm
# The packages' wheels bring all that they load; nothing is installed from Debian.
RUN useradd --uid 10001 --user-group --no-create-home --home-dir /data --shell /usr/sbin/nologin galatea \
 && install -d -o galatea -g galatea -m 0700 /data
COPY --from=packages /opt/galatea /opt/galatea
WORKDIR /app
COPY pyproject.toml README.md LICENSE ./
COPY engine engine
COPY service service
COPY worker worker
COPY shell shell
COPY scripts/model_files.py scripts/identity_model.lock scripts/salience_model.lock scripts/
RUN /opt/galatea/bin/pip install --no-cache-dir --no-deps --no-build-isolation --editable . \
 && /opt/galatea/bin/python -m scripts.model_files \
 && /opt/galatea/bin/python -m compileall -q engine service worker shell
COPY --from=page /page/dist service/web
COPY --from=page /page/reactive/dist/reactive-portrait.js engine/portrait/reactive/player/
# The root may be read-only: everything that is written lies under /data and /tmp.
ENV PATH=/opt/galatea/bin:$PATH \
    PYTHONDONTWRITEBYTECODE=1 \
    GALATEA_DATA_DIR=/data \
    GALATEA_LOG_FORMAT=json \
    NUMBA_CACHE_DIR=/data/numba \
    MPLCONFIGDIR=/tmp
USER galatea
VOLUME /data
EXPOSE 8000
ENTRYPOINT ["galatea"]
CMD ["serve"]
