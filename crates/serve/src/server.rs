//! Sockets: how many connections, how long, how large.

use std::convert::Infallible;
use std::io;
use std::net::{SocketAddr, TcpListener};
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;

use http_body_util::{BodyExt, Full, Limited};
use hyper::body::{Body, Bytes, Incoming};
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper::{Request, Response, StatusCode};
use hyper_util::rt::{TokioIo, TokioTimer};
use tokio::net::TcpStream;
use tokio::sync::{Semaphore, SemaphorePermit};
use tokio::time::timeout;

use super::door::Door;
use super::exchange::Reply;
use super::routes::Routes;

/// Connections at a time: a browser opens six for a page.
const MOST_CONNECTIONS: usize = 128;

/// Bytes of a request: a recording of a million rows.
const MOST_BYTES: u64 = 64 << 20;

/// Mebibytes of all requests that are read at a time.
const MOST_TOGETHER: usize = 256;

/// Bytes of the head of a request.
const MOST_HEAD: usize = 32 << 10;

/// Within which a head has to arrive.
const HEAD_TIME: Duration = Duration::from_secs(30);

/// Within which a body has to arrive.
const BODY_TIME: Duration = Duration::from_secs(60);

/// A server that listens, for one folder.
#[derive(Debug)]
pub struct Workbench {
    listener: TcpListener,
    house: House,
}

/// What all connections share.
#[derive(Debug)]
struct House {
    door: Door,
    routes: Routes,
    /// Mebibytes that may still be read.
    room: Semaphore,
}

impl Workbench {
    /// Listens at an address (port 0: one that is free) for requests about the files of a folder.
    ///
    /// # Errors
    /// The folder cannot be read, the address is taken, or the system has no random numbers.
    pub fn bind(folder: &Path, address: SocketAddr) -> io::Result<Workbench> {
        let root = std::fs::canonicalize(folder)?;
        std::fs::read_dir(&root)?;
        let listener = TcpListener::bind(address)?;
        listener.set_nonblocking(true)?;
        let house = House {
            door: Door::new(listener.local_addr()?)?,
            routes: Routes::new(root),
            room: Semaphore::new(MOST_TOGETHER),
        };
        Ok(Workbench { listener, house })
    }

    /// The address of the page. Whoever knows it may do what the page does.
    pub fn address(&self) -> String {
        self.house.door.address()
    }

    /// Answers until the program ends.
    ///
    /// # Errors
    /// The system takes no connections any more.
    pub fn run(self) -> io::Result<()> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .enable_time()
            .build()?;
        runtime.block_on(self.accept())
    }

    async fn accept(self) -> io::Result<()> {
        let listener = tokio::net::TcpListener::from_std(self.listener)?;
        let house = Arc::new(self.house);
        let places = Arc::new(Semaphore::new(MOST_CONNECTIONS));
        loop {
            let Ok(place) = Arc::clone(&places).acquire_owned().await else {
                return Ok(());
            };
            // Too many open files, or a connection that is gone: others come.
            let Ok((stream, _)) = listener.accept().await else {
                tokio::time::sleep(Duration::from_millis(50)).await;
                continue;
            };
            let house = Arc::clone(&house);
            tokio::spawn(async move {
                house.serve(stream).await;
                drop(place);
            });
        }
    }
}

impl House {
    async fn serve(self: Arc<Self>, stream: TcpStream) {
        // An answer is whole when it is written: nothing is gained by waiting for more.
        let _ = stream.set_nodelay(true);
        let answer = service_fn(move |request| {
            let house = Arc::clone(&self);
            async move { Ok::<_, Infallible>(house.answer(request).await) }
        });
        let connection = http1::Builder::new()
            .timer(TokioTimer::new())
            .header_read_timeout(HEAD_TIME)
            .max_buf_size(MOST_HEAD)
            .serve_connection(TokioIo::new(stream), answer);
        // A browser that has gone away is no error.
        let _ = connection.await;
    }

    async fn answer(&self, request: Request<Incoming>) -> Response<Full<Bytes>> {
        let (head, body) = request.into_parts();
        let Ok(path) = self.door.enter(head.uri.path(), &head.headers) else {
            return Reply::status(StatusCode::FORBIDDEN).response();
        };
        let reply = match self.received(body).await {
            Ok((body, _room)) => self.routes.answer(&head.method, path, body).await,
            Err(status) => Reply::status(status),
        };
        reply.response()
    }

    /// The body of a request, and the room that it takes until it is answered; of one that does not say how long it is, none.
    async fn received(
        &self,
        body: Incoming,
    ) -> Result<(Bytes, Option<SemaphorePermit<'_>>), StatusCode> {
        let Some(bytes) = body.size_hint().exact() else {
            return Err(StatusCode::LENGTH_REQUIRED);
        };
        if bytes > MOST_BYTES {
            return Err(StatusCode::PAYLOAD_TOO_LARGE);
        }
        let mebibytes = bytes.div_ceil(1 << 20) as u32;
        let whole = async {
            let room = self.room.acquire_many(mebibytes).await.ok();
            let whole = Limited::new(body, MOST_BYTES as usize).collect().await;
            whole.map(|whole| (whole.to_bytes(), room))
        };
        match timeout(BODY_TIME, whole).await {
            Ok(Ok(whole)) => Ok(whole),
            Ok(Err(_)) => Err(StatusCode::BAD_REQUEST),
            Err(_) => Err(StatusCode::REQUEST_TIMEOUT),
        }
    }
}
