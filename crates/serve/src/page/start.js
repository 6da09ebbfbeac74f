"use strict";
// Begins when everything else is there.

speak(language);
refresh().then(names => {
  const wanted = decodeURIComponent(location.hash.slice(1));
  const first = names.includes(wanted) ? wanted : names[0];
  return first ? open(first) : note(word("none"));
}).catch(() => say(word("lost")));
