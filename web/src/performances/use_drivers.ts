/** The performances that can be named; those that are being searched for moments are looked at again. */

import { useEffect } from 'preact/hooks';
import { type Driver, listDrivers } from '../api';
import { type Loading, useLoaded } from '../api/loading';

const SEARCH_POLL_MS = 2000;

export function useDrivers(): Loading<Driver[]> {
  const drivers = useLoaded(listDrivers, 'drivers');
  const searching = drivers.value?.some((driver) => driver.moments_status === 'pending') ?? false;
  useEffect(() => {
    if (!searching) return;
    const timer = setInterval(drivers.reload, SEARCH_POLL_MS);
    return () => clearInterval(timer);
  }, [searching]);
  return drivers;
}
